// A farm of our real programs on loopback, for figures: a master, and workers that have joined it over TLS.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/net/codec.h"
#include "master/http/client.h"
#include "master/http/submission.h"
#include "master/script/script.h"
#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {

using Words = std::vector<std::string>;

class RealFarm {
 public:
  /// With a journal and keys, or with neither: then all is plaintext.
  enum class Kind { kept_and_encrypted, plain };

  explicit RealFarm(Kind kind)
      : kind_(kind), master_(words_of(kind, folder_.path()), {}, folder_ / "master.log") {
    const std::string line = master_.next_line();  // rayfarm-master: workers ADDRESS, http URL
    const std::size_t comma = line.find(','), http = line.rfind(' ');
    if (comma == std::string::npos) throw std::runtime_error("the master did not start: " + line);
    address_ = line.substr(line.rfind(' ', comma) + 1, comma - line.rfind(' ', comma) - 1);
    http_ = line.substr(http + 1);
  }

  /// Pairs a worker of that name; its state folder.
  std::string join(const std::string& name) const {
    const ProgramResult made = run_program({"rayfarm", "token", "new"}, {{"RAYFARM_MASTER", http_}});
    const std::string code = made.out.substr(0, made.out.find('\n'));
    const std::string state = folder_ / name;
    const ProgramResult joined =
        run_program({"rayfarm-worker", "join", code, "--name", name, "--state", state});
    if (joined.exit_code != 0) throw std::runtime_error(made.err + joined.err);
    return state;
  }
  /// A worker's program; of a farm with keys one that has joined.
  std::unique_ptr<ChildProgram> worker(const std::string& name, int threads) const {
    Words words{"rayfarm-worker", "--name", name, "--threads", std::to_string(threads)};
    const Words way = kind_ == Kind::plain ? Words{"--master", address_} : Words{"--state", folder_ / name};
    words.insert(words.end(), way.begin(), way.end());
    return std::make_unique<ChildProgram>(words, std::map<std::string, std::string>{},
                                          folder_ / (name + ".log"));
  }

  nlohmann::json ask(const std::string& target) const {
    return answer({.url = http_, .target = target, .body = {}});
  }
  nlohmann::json post(const std::string& target, const nlohmann::json& body) const {
    return answer({.method = "POST", .url = http_, .target = target, .body = body.dump()});
  }
  std::uint64_t submit(const JobSpec& spec) const { return post("/api/v1/jobs", to_json(spec)).at("id"); }
  std::string state_of(std::uint64_t job) const {
    return ask("/api/v1/jobs/" + std::to_string(job)).at("state");
  }
  /// Null when it is not here.
  nlohmann::json worker_view(const std::string& name) const {
    const nlohmann::json all = ask("/api/v1/workers");
    for (const nlohmann::json& worker : all.at("workers"))
      if (worker.at("name") == name) return worker;
    return nullptr;
  }
  template <class Condition>
  void wait_until(Condition condition) const {
    while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  void wait_for(const std::string& name) const {
    wait_until([&] { return !worker_view(name).is_null(); });
  }

  const std::string& http() const { return http_; }
  pid_t pid() const { return master_.pid(); }

 private:
  static Words words_of(Kind kind, const std::string& state) {
    Words words{"rayfarm-master", "--listen", "127.0.0.1:0", "--http", "127.0.0.1:0", "--threads", "0"};
    if (kind == Kind::kept_and_encrypted) words.insert(words.end(), {"--state", state});
    return words;
  }
  static nlohmann::json answer(const HttpRequest& request) {
    const HttpReply reply = send(request);
    if (reply.status / 100 != 2) throw std::runtime_error(request.target + ": " + reply.body);
    return nlohmann::json::parse(reply.body);
  }

  ScratchFolder folder_;
  Kind kind_;
  ChildProgram master_;
  std::string address_, http_;
};

/// Of a bundled script.
inline JobSpec job_of_script(const std::string& name, const RenderSettings& settings) {
  JobSpec spec;
  const auto bytes = std::make_shared<const Bytes>(
      encode_scene(evaluate_file(RAYFARM_SOURCE_DIR "/scenes/" + name + ".lua", {}, 0).scene));
  spec.name = name, spec.scene_hash = sha256_hex(*bytes), spec.scene_bytes = bytes;
  spec.settings = settings;
  return spec;
}

inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace rayfarm
