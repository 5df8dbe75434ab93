// HTTP requests, from their first byte to the answer's head: what the server does, without its sockets.
//
// Law: nothing that a request brings ends a line of the answer's head.
#include <boost/asio/buffer.hpp>
#include <mutex>

#include "master/diagnostics/diagnostics.h"
#include "master/http/api.h"
#include "master/http/guard.h"
#include "master/http/http_words.h"
#include "master/http/people.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/random_scene.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t header_limit = 8 * 1024;

/// What stands behind a master's HTTP server.
class Master {
 public:
  Master() {
    const auto scene = std::make_shared<const Bytes>(encode_scene(random_scene(1)));
    JobSpec spec;
    spec.scene_hash = sha256_hex(*scene), spec.scene_bytes = scene;
    spec.settings.width = 8, spec.settings.height = 6, spec.settings.spp = 1;
    farm_.submit(spec, FarmTime{});
  }
  ApiResponse answer_to(const ApiRequest& request) {
    return answer(request,
                  {farm_door_, feeder_, diagnostics_, master_door_, app_, scenes_, assets_, &access_});
  }
  Access& access() { return access_; }

 private:
  const ScratchFolder folder_;
  Access access_{folder_.path(), {"localhost"}, std::chrono::system_clock::now()};
  std::mutex mutex_;  // the feeder has a thread of its own
  Farm farm_{FarmLimits{.film_bytes = 1 << 20, .jobs = 10, .unfinished_jobs = 10, .scene_bytes = 1 << 20}};
  FarmDoor farm_door_{[this](const std::function<void(Farm&, FarmTime)>& task) {
    const std::lock_guard lock(mutex_);
    task(farm_, FarmTime{});
  }};
  FrameFeeder feeder_{farm_door_};
  Diagnostics diagnostics_{1};
  const MasterDoor master_door_{[](const std::string&) {},
                                [] { return std::vector<Dialling>{}; },
                                [](std::uint64_t) { return std::vector<LogLine>{}; },
                                [](const std::string&) { return false; },
                                [](const std::set<std::string>&) {},
                                [](const std::string&) {}};
  const AppFiles app_{"/nowhere"};
  const SceneLibrary scenes_{"/nowhere"};
  AssetStore assets_;
};

/// A new one now and then, so that what others have left does not grow.
Master& master() {
  static std::unique_ptr<Master> current;
  static int requests = 0;
  if (requests++ % 1000 == 0) current = std::make_unique<Master>();
  return *current;
}

void check_head(const ApiResponse& answer, const RequestParser::value_type& request) {
  const Response response = http_response(answer, request, true);
  for (const auto& field : response)
    require(field.value().find_first_of("\r\n") == std::string_view::npos,
            "a field of the answer is one line");
}

std::optional<ApiResponse> refusal_of(const ApiRequest& request) {
  static const ListenAddress listening{"127.0.0.1", true, "pc7"};
  if (auto refused = refusal(request, listening)) return refused;
  const std::optional<Role> needed = role_needed(request);
  if (!needed) return std::nullopt;
  return denial(asker_of(request, Exposure::loopback_only, &master().access(), [](const std::string&) {}),
                *needed);
}

}  // namespace

void fuzz(ByteView bytes) {
  RequestParser parser;
  parser.header_limit(header_limit);
  boost::system::error_code error;
  const std::size_t head = parser.put(boost::asio::buffer(bytes.data(), bytes.size()), error);
  if (error || !parser.is_header_done()) {
    complaint(error, 0);
    return;
  }
  ApiRequest request = api_request(parser.get());
  request.from = "127.0.0.1";
  if (const auto refused = refusal_of(request)) return check_head(*refused, parser.get());
  parser.body_limit(body_limit(request));
  parser.eager(true);
  bytes = bytes.subspan(head);
  while (!bytes.empty() && !parser.is_done() && !error) {
    const std::size_t taken = parser.put(boost::asio::buffer(bytes.data(), bytes.size()), error);
    if (taken == 0) break;
    bytes = bytes.subspan(taken);
  }
  if (error || !parser.is_done()) {
    complaint(error, body_limit(request));
    return;
  }
  request.body = std::move(parser.get().body());
  news_wait(request);
  check_head(master().answer_to(request), parser.get());
}

}  // namespace rayfarm
