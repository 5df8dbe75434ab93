// SIGINT, SIGTERM, and SIGHUP unless it is ignored (nohup).
#pragma once
#include <asio/signal_set.hpp>
#include <functional>

namespace rayfarm {

class StopSignals {
 public:
  /// Calls `stop` at the first signal, on the thread that runs io; the second ends the program at once, with
  /// the exit code of a program that was interrupted.
  StopSignals(asio::io_context& io, std::function<void()> stop);

 private:
  void wait_for_second();

  asio::signal_set signals_;
  std::function<void()> stop_;
};

}  // namespace rayfarm
