// What a crew, or anything else on another thread, has said so far; to be waited for.
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>

#include "common/net/messages.h"

namespace rayfarm {

class Answers {
 public:
  void add(ToMaster message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
    came_.notify_all();
  }
  /// The next one, once it has come.
  ToMaster next() {
    std::unique_lock lock(mutex_);
    came_.wait(lock, [this] { return !messages_.empty(); });
    ToMaster message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  bool empty() {
    const std::lock_guard lock(mutex_);
    return messages_.empty();
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<ToMaster> messages_;
};

}  // namespace rayfarm
