#include "master/http/server.h"

#include <poll.h>

#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <thread>

#include "common/net/text.h"
#include "common/net/tls.h"
#include "master/http/api.h"
#include "master/http/guard.h"
#include "master/http/guests.h"
#include "master/http/http_stream.h"
#include "master/http/http_words.h"
#include "master/http/listen.h"
#include "master/http/live/session.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

constexpr std::uint32_t header_limit = 8 * 1024;
constexpr std::uint64_t memory_for_bodies = 4 * submission_limit;     // of all peers together
constexpr std::uint64_t memory_for_answers = std::uint64_t{1} << 30;  // that peers have not taken yet
constexpr std::uint64_t large_answer = 1 << 20;                       // bytes; smaller ones are not counted
constexpr auto write_patience = std::chrono::seconds(60);             // while the peer takes nothing
constexpr auto farewell_patience = std::chrono::seconds(2);
constexpr auto news_glance = std::chrono::milliseconds(100);  // the changes of many tiles make one answer

bool is_live(const RequestParser::value_type& request) {
  return beast::websocket::is_upgrade(request) && request.target() == live_path;
}

/// Some of the memory that many share, until it is let go.
class MemoryShare {
 public:
  MemoryShare(std::uint64_t& taken, std::uint64_t bytes) : taken_(taken), bytes_(bytes) { taken_ += bytes_; }
  ~MemoryShare() { taken_ -= bytes_; }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

 private:
  std::uint64_t& taken_;
  const std::uint64_t bytes_;
};

/// True when the peer has closed the connection, or its half of it.
bool has_left(int socket) {
  pollfd looked_at{socket, POLLRDHUP, 0};
  return ::poll(&looked_at, 1, 0) > 0;
}

/// What follows an answer; nothing: the connection is no longer ours.
enum class Then : std::uint8_t { next_request, farewell, nothing };

}  // namespace

struct HttpServer::Parts {
  Parts(const HttpSettings& settings, const Doors& doors)
      : settings(settings),
        doors(doors),
        live(io, live_threads, doors, settings.viewer_patience),
        acceptor(acceptor_at(io, settings)) {
    listening = address_of(acceptor, settings);
    our_url = outward_url_of(acceptor, settings);
    if (settings.identity) tls.emplace(share(web_context(*settings.identity)));
  }

  asio::awaitable<void> accept_all();
  asio::awaitable<void> session(HttpStream stream);
  bool make_room();
  asio::awaitable<bool> greet(HttpStream& stream, beast::flat_buffer& buffer);
  asio::awaitable<void> see_off(HttpStream& stream);
  asio::awaitable<Then> converse(HttpStream& stream, beast::flat_buffer& buffer, Guest& guest);
  asio::awaitable<Then> reply(HttpStream& stream, ApiResponse answer,
                              const RequestParser::value_type& request, bool keep_alive);
  asio::awaitable<ApiResponse> respond(const ApiRequest& request);
  asio::awaitable<void> await_news(NewsWait wait);
  asio::awaitable<ApiResponse> answer_in_pool(const ApiRequest& request);
  asio::awaitable<bool> has_come(NewsWait wait);
  asio::thread_pool& threads_for(Work work) { return threads[static_cast<std::size_t>(work)]; }

  std::optional<Asker> let_in(const ApiRequest& request, std::optional<ApiResponse>& refused) const;
  /// Whether who showed this may still look.
  bool may_look(const std::string& shown, const std::string& from) const;

  const HttpSettings settings;
  const Doors doors;
  std::optional<asio::ssl::context> tls;
  ListenAddress listening;
  std::string our_url;
  Guests guests;
  IdleConnections idle;
  std::uint64_t body_bytes = 0;    // that peers may send just now
  std::uint64_t answer_bytes = 0;  // that peers have not taken yet
  LiveSessions live;
  // What waits in these owns sessions, which use the members above.
  asio::io_context io{1};
  tcp::acceptor acceptor;
  std::array<asio::thread_pool, 6> threads{asio::thread_pool(1), asio::thread_pool(8),
                                           asio::thread_pool(1), asio::thread_pool(2),
                                           asio::thread_pool(4), asio::thread_pool(2)};  // by kind of work
  asio::thread_pool live_threads{1};
  std::jthread thread;
};

asio::awaitable<void> HttpServer::Parts::accept_all() {
  for (;;) {
    boost::system::error_code error;
    tcp::socket socket = co_await acceptor.async_accept(asio::redirect_error(asio::use_awaitable, error));
    if (error) {  // out of descriptors, say: the sessions there are will end
      asio::steady_timer pause(io, news_glance);
      co_await pause.async_wait(asio::use_awaitable);
      continue;
    }
    if (guests.count() >= settings.connections && !make_room()) continue;  // closes it
    asio::co_spawn(io, session(HttpStream(beast::tcp_stream(std::move(socket)))), asio::detached);
  }
}

/// For one more. Who was told to go may take a moment, but not all of them.
bool HttpServer::Parts::make_room() {
  if (guests.count() >= 2 * settings.connections) return false;
  if (idle.empty()) return guests.send_away_one();
  idle.front()->next_layer().close();
  return true;
}

/// Ends when the peer does, on the first mistake, or when patience does.
asio::awaitable<void> HttpServer::Parts::session(HttpStream stream) {
  const Guests::Stay stay(guests, stream.next_layer().socket().native_handle());
  Then then = Then::next_request;
  try {
    beast::flat_buffer buffer(header_limit + 1024);
    if (!co_await greet(stream, buffer)) then = Then::nothing;
    while (then == Then::next_request) then = co_await converse(stream, buffer, stay.guest());
  } catch (const std::exception&) {  // of the peer's making; nobody is left to be told
    then = Then::farewell;
  }
  if (then == Then::farewell) co_await see_off(stream);
}

/// TLS or plaintext, as the peer begins; false: the latter is not spoken with it, and nothing is said.
asio::awaitable<bool> HttpServer::Parts::greet(HttpStream& stream, beast::flat_buffer& buffer) {
  const IdleTime idling(idle, stream);
  stream.next_layer().expires_after(settings.header_patience);
  const bool wants_tls = co_await beast::async_detect_ssl(stream.next_layer(), buffer, asio::use_awaitable);
  const auto from = peer_address(stream.next_layer().socket());
  if (!wants_tls && !allows_plaintext(settings, from))
    doors.master.tell("nobody at " + from.to_string() + ": it asks without encryption");
  if (!wants_tls) co_return allows_plaintext(settings, from);
  if (!tls) co_return false;
  HttpStream::Tls& encrypted = stream.encrypt(*tls);
  const asio::const_buffer begun = buffer.cdata();
  buffer.consume(
      co_await encrypted.async_handshake(asio::ssl::stream_base::server, begun, asio::use_awaitable));
  co_return true;
}

bool HttpServer::Parts::may_look(const std::string& shown, const std::string& from) const {
  if (shown.empty()) return true;
  try {
    doors.access->check_person(shown, from, std::chrono::system_clock::now());
    return true;
  } catch (const AccessRefused&) {
    return false;
  }
}

/// Who asks, if somebody must be known; else what they get instead of an answer goes into `refused`. From any thread.
std::optional<Asker> HttpServer::Parts::let_in(const ApiRequest& request,
                                               std::optional<ApiResponse>& refused) const {
  const std::optional<Role> needed = role_needed(request);
  if (!needed) return std::nullopt;
  std::optional<Asker> asker = asker_of(request, settings.exposure, doors.access, doors.master.tell);
  refused = denial(asker, *needed);
  const bool is_short = request.target.size() <= 100 && is_plain_text(request.target);
  if (refused && asker)
    doors.master.tell("who is " + std::string(name_of(asker->role)) + " at " + request.from + " may not " +
                      request.method + " " + (is_short ? request.target : "what they ask for"));
  return asker;
}

/// Reads and forgets what the peer still sends, for a while: closing at once would reset the connection, and
/// the answer could be lost on its way.
asio::awaitable<void> HttpServer::Parts::see_off(HttpStream& stream) {
  const IdleTime idling(idle, stream);
  boost::system::error_code error, ignored_error;
  stream.next_layer().expires_after(farewell_patience);
  if (stream.tls()) co_await stream.tls()->async_shutdown(asio::redirect_error(asio::use_awaitable, error));
  stream.next_layer().socket().shutdown(tcp::socket::shutdown_send, ignored_error);
  std::array<char, 4096> ignored;
  const asio::mutable_buffer buffer = asio::buffer(ignored);
  while (!error)
    co_await stream.next_layer().async_read_some(buffer, asio::redirect_error(asio::use_awaitable, error));
}

/// One request and its answer.
asio::awaitable<Then> HttpServer::Parts::converse(HttpStream& stream, beast::flat_buffer& buffer,
                                                  Guest& guest) {
  RequestParser parser;
  parser.header_limit(header_limit);
  parser.body_limit(submission_limit);
  boost::system::error_code error;

  {
    const IdleTime idling(idle, stream);
    stream.next_layer().expires_after(settings.header_patience);
    co_await http::async_read_header(stream, buffer, parser,
                                     asio::redirect_error(asio::use_awaitable, error));
  }
  ApiRequest request = api_request(parser.get());
  request.from = peer_address(stream.next_layer().socket()).to_string(), request.our_url = our_url;
  request.is_encrypted = stream.tls() != nullptr;
  std::optional<ApiResponse> refused =
      error ? complaint(error, submission_limit) : refusal(request, listening);
  if (refused && refused->status == 403)
    doors.master.tell("nobody at " + request.from + ": a page from elsewhere, or for another name, asks");
  if (error && !refused) co_return Then::farewell;
  const std::optional<Asker> asker = refused ? std::nullopt : let_in(request, refused);
  request.denial = [this, &request] {
    std::optional<ApiResponse> denied;
    let_in(request, denied);
    return denied;
  };
  if (asker) guest.who = asker->shown.empty() ? request.from : asker->shown;
  std::optional<IdleTime> yielding;  // who is nobody makes room for others until the answer is theirs
  if (!asker) yielding.emplace(idle, stream);
  const std::uint64_t limit = body_limit(request);
  const std::uint64_t expected = refused ? 0 : expected_body(parser, limit);
  if (!refused && expected > limit) refused = complaint(http::error::body_limit, limit);
  if (!refused && body_bytes + expected > memory_for_bodies)
    refused = error_response(503, "too many scenes are being submitted at once; try again");
  const MemoryShare share(body_bytes, refused ? 0 : expected);  // ends with the answer

  if (!refused) {
    parser.body_limit(limit);  // for a body in chunks, which does not tell its size
    stream.next_layer().expires_after(settings.body_patience);
    co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, error));
    if (error) refused = complaint(error, limit);
    if (error && !refused) co_return Then::farewell;
    if (!refused) refused = request.denial();  // the token may have been revoked while the body came
  }
  if (refused) co_return co_await reply(stream, std::move(*refused), parser.get(), false);
  if (is_live(parser.get())) {
    RequestParser::value_type upgrade = parser.release();
    std::function<bool()> may_stay = [this, shown = asker->shown, from = request.from] {
      return may_look(shown, from);
    };
    co_await live.serve(std::move(stream), std::move(upgrade), std::move(may_stay));
    co_return Then::nothing;
  }

  request.body = std::move(parser.get().body());
  request.has_left = [socket = stream.next_layer().socket().native_handle()] { return has_left(socket); };
  ApiResponse answered = co_await respond(request);
  if (request.method == "GET")  // nor does who was let in then see what there is now
    if (std::optional<ApiResponse> denial = request.denial()) answered = std::move(*denial);
  co_return co_await reply(stream, std::move(answered), parser.get(), parser.get().keep_alive());
}

asio::awaitable<Then> HttpServer::Parts::reply(HttpStream& stream, ApiResponse answer,
                                               const RequestParser::value_type& request, bool keep_alive) {
  if (answer.body.size() >= large_answer && answer_bytes > 0 &&
      answer_bytes + answer.body.size() > memory_for_answers)
    answer = error_response(503, "too many pictures are being fetched at once; try again");
  const MemoryShare share(answer_bytes, answer.body.size() >= large_answer ? answer.body.size() : 0);
  Response response = http_response(answer, request, keep_alive);
  http::response_serializer<http::span_body<const char>> serializer(response);
  const bool is_head = request.method() == http::verb::head;  // who wants no body
  serializer.split(is_head);
  while (is_head ? !serializer.is_header_done() : !serializer.is_done()) {
    stream.next_layer().expires_after(write_patience);
    co_await http::async_write_some(stream, serializer, asio::use_awaitable);
  }
  co_return response.keep_alive() ? Then::next_request : Then::farewell;
}

/// What is not there yet is asked for again while the peer wants to wait.
asio::awaitable<ApiResponse> HttpServer::Parts::respond(const ApiRequest& request) {
  const auto end = std::chrono::steady_clock::now() + patience_of(request);
  const std::optional<NewsWait> wait = news_wait(request);
  if (wait) co_await await_news(*wait);
  for (;;) {
    asio::awaitable<ApiResponse> answering = answer_in_pool(request);
    ApiResponse answered =
        co_await asio::co_spawn(threads_for(work_of(request)), std::move(answering), asio::use_awaitable);
    if (answered.status != 202 || std::chrono::steady_clock::now() >= end) co_return answered;
    asio::steady_timer pause(io, news_glance);
    co_await pause.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<void> HttpServer::Parts::await_news(NewsWait wait) {
  const auto end = std::chrono::steady_clock::now() + wait.longest;
  while (std::chrono::steady_clock::now() < end) {
    asio::awaitable<bool> asking = has_come(wait);
    if (co_await asio::co_spawn(threads_for(Work::command), std::move(asking), asio::use_awaitable))
      co_return;
    asio::steady_timer pause(io, news_glance);
    co_await pause.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<ApiResponse> HttpServer::Parts::answer_in_pool(const ApiRequest& request) {
  co_return answer(request, doors);
}

asio::awaitable<bool> HttpServer::Parts::has_come(NewsWait wait) {
  co_return doors.farm.ask([wait](Farm& farm, FarmTime now) {
    return farm.revision() != wait.after || (wait.job && !farm.job(*wait.job, now));
  });
}

HttpServer::HttpServer(const HttpSettings& settings, const Doors& doors)
    : parts_(std::make_unique<Parts>(settings, doors)) {
  asio::co_spawn(parts_->io, parts_->accept_all(), asio::detached);
  parts_->thread = std::jthread([parts = parts_.get()] { parts->io.run(); });
}

HttpServer::~HttpServer() {
  for (asio::thread_pool& pool : parts_->threads) pool.stop();  // what has not begun is dropped
  parts_->live_threads.stop();
  parts_->doors.farm.close();
  parts_->io.stop();
  parts_->thread.join();
  for (asio::thread_pool& pool : parts_->threads) pool.join();
  parts_->live_threads.join();
}

std::string HttpServer::url() const { return url_of(parts_->acceptor, parts_->settings); }

}  // namespace rayfarm
