#include "common/daemon/stop_signals.h"

#include <csignal>
#include <cstdlib>

namespace rayfarm {

namespace {

constexpr int interrupted = 130;

/// Under nohup the end of the terminal shall not be heard.
bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

StopSignals::StopSignals(asio::io_context& io, std::function<void()> stop)
    : signals_(io, SIGINT, SIGTERM), stop_(std::move(stop)) {
  if (!is_ignored(SIGHUP)) signals_.add(SIGHUP);
  signals_.async_wait([this](asio::error_code error, int) {
    if (error) return;
    wait_for_second();
    stop_();
  });
}

void StopSignals::wait_for_second() {
  signals_.async_wait([](asio::error_code error, int) {
    if (!error) std::_Exit(interrupted);
  });
}

}  // namespace rayfarm
