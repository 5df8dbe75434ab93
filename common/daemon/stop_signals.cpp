#include "common/daemon/stop_signals.h"

#include <csignal>
#include <cstdlib>

namespace rayfarm {

constexpr int interrupted = 130;

StopSignals::StopSignals(asio::io_context& io, std::function<void()> stop)
    : signals_(io, SIGINT, SIGTERM), stop_(std::move(stop)) {
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
