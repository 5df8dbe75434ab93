// A farm with its door for workers, on a thread of its own.
#pragma once
#include <asio/post.hpp>
#include <future>

#include "common/net/run_until_end.h"
#include "master/http/doors.h"
#include "master/sessions.h"

namespace rayfarm {

/// No deadline within a test; back-off without waiting.
inline DoorLimits patient_door() {
  using namespace std::chrono_literals;
  return {{100ms, 60s, 60s}, {1ms, 10ms}};
}

class MasterThread {
  /// Runs the call on the farm's thread, and waits.
  template <class Call>
  auto on_thread(Call call) {
    std::packaged_task<decltype(call())()> task(std::move(call));
    auto answer = task.get_future();
    asio::post(io_, std::move(task));
    return answer.get();
  }

 public:
  explicit MasterThread(DoorLimits times = patient_door(), const Address& listen = {"127.0.0.1", 0},
                        Security security = {}, Access* access = nullptr)
      : sessions_(io_, farm_, listen, std::move(security), times, access) {
    ended_ = std::async(std::launch::async, [this] { run_until_end(io_, sessions_.run()); });
  }
  /// As kill -9 would: nobody is told.
  ~MasterThread() { io_.stop(); }

  const Address& address() const { return sessions_.listening_at(); }

  /// What question(farm, now) answers on the farm's thread.
  template <class Question>
  auto ask(Question question) {
    return on_thread([&] { return farm_.apply(question); });
  }
  /// For an HTTP server.
  OnFarm on_farm() {
    return [this](std::function<void(Farm&, FarmTime)> question) {
      asio::post(io_, [this, question = std::move(question)] { farm_.apply(question); });
    };
  }
  MasterDoor door() {
    return {[this](const std::string& target) { sessions_.dial(parse_dial_target(target)); },
            [this] { return sessions_.dialling(); },
            [this](std::uint64_t after) { return farm_.log().after(after); },
            [this](const std::string& name) { return sessions_.stop_dialling(name); },
            [this](const std::set<std::string>& certificates) { sessions_.cut_off(certificates); },
            [this](const std::string& line) {
              asio::post(io_, [this, line] { farm_.note({true, line, ""}); });
            }};
  }
  /// Waits until the farm says yes.
  template <class Question>
  void wait_until(Question question) {
    while (!ask([&](Farm& farm, FarmTime) { return question(farm); })) std::this_thread::yield();
  }
  void wait_for_workers(std::size_t count) {
    wait_until([&](Farm& farm) { return farm.workers().size() == count; });
  }
  void dial(DialTarget target) {
    on_thread([&] { sessions_.dial(std::move(target)); });
  }
  /// Made on the farm's thread, as it must be.
  template <class Made, class... Arguments>
  std::shared_ptr<Made> make(Arguments... arguments) {
    return on_thread([&] { return std::make_shared<Made>(io_, farm_, std::move(arguments)...); });
  }
  template <class Made>
  void end(std::shared_ptr<Made>& made) {
    on_thread([&] { made.reset(); });
  }

  void stop() {
    on_thread([&] { sessions_.stop(); });
  }
  void wait_for_end() { ended_.get(); }

 private:
  asio::io_context io_;
  LiveFarm farm_;
  Sessions sessions_;
  std::future<void> ended_;  // first to go: waits for the thread
};

}  // namespace rayfarm
