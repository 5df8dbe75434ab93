// How the threads of the HTTP server ask the farm, which lives on another one.
#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "master/farm.h"

namespace rayfarm {

/// Runs the closure on the farm's thread, some time later; drops it when the master is stopping.
using OnFarm = std::function<void(std::function<void(Farm&, FarmTime)>)>;
/// Told why what was done will not outlive the master; nothing when it will.
using Told = std::function<void(const std::optional<std::string>& fault)>;

/// Returns when what was done will outlive the power, too, or why it will not.
using UntilSynced = std::function<std::optional<std::string>()>;

struct FarmUnavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct NotKept : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class FarmDoor {
 public:
  /// once_kept(told) is called on the farm's thread, within a closure of on_farm, and tells after its end.
  /// until_synced() is called on that of an asker.
  explicit FarmDoor(
      OnFarm on_farm, std::function<void(Told)> once_kept = [](const Told& told) { told({}); },
      UntilSynced until_synced = [] { return std::nullopt; })
      : on_farm_(std::move(on_farm)),
        once_kept_(std::move(once_kept)),
        until_synced_(std::move(until_synced)) {}

  /// Runs question(farm, now) on the farm's thread and waits for its answer. The question must own what it
  /// uses: the wait can end first. Nobody is told what the end of the master could undo. Throws what the question
  /// throws; NotKept when it was done, but may be undone; FarmUnavailable after close() or 10 s: the question is then
  /// never asked, so it may be tried again.
  template <class Question>
  std::invoke_result_t<Question&, Farm&, FarmTime> ask(Question question) const {
    using Answer = std::invoke_result_t<Question&, Farm&, FarmTime>;
    auto promise = std::make_shared<std::promise<Answer>>();
    std::future<Answer> answer = promise->get_future();
    // Set by whoever is first: the farm to answer, or the asker to leave.
    auto decided = std::make_shared<std::atomic_flag>();
    on_farm_([this, promise = std::move(promise), decided, question = std::move(question)](
                 Farm& farm, FarmTime now) mutable {
      if (decided->test_and_set()) return;
      try {
        auto found = std::make_shared<Answer>(question(farm, now));
        once_kept_([promise, found](const std::optional<std::string>& fault) {
          if (fault)
            promise->set_exception(std::make_exception_ptr(NotKept(*fault)));
          else
            promise->set_value(std::move(*found));
        });
      } catch (...) {
        promise->set_exception(std::current_exception());
      }
    });
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (answer.wait_for(glance) != std::future_status::ready) {
      const bool is_closed = closed_;
      if ((is_closed || std::chrono::steady_clock::now() > deadline) && !decided->test_and_set())
        throw FarmUnavailable("the master is stopping or very busy; try again");
      if (is_closed) throw NotKept("the master is stopping");
    }
    try {
      return answer.get();
    } catch (const std::future_error&) {  // the closure was dropped
      throw FarmUnavailable("the master is stopping");
    }
  }

  /// As ask(), for what people order: nobody is told of it what a power cut could undo.
  template <class Order>
  std::invoke_result_t<Order&, Farm&, FarmTime> order(Order order) const {
    auto done = ask(std::move(order));
    if (const std::optional<std::string> fault = until_synced_()) throw NotKept(*fault);
    return done;
  }

  /// Waiting askers leave: the farm's thread may be the one that wants them gone.
  void close() { closed_ = true; }

 private:
  static constexpr auto patience = std::chrono::seconds(10);
  static constexpr auto glance = std::chrono::milliseconds(50);  // how late close() may be seen

  OnFarm on_farm_;
  std::function<void(Told)> once_kept_;
  UntilSynced until_synced_;
  std::atomic<bool> closed_{false};
};

}  // namespace rayfarm
