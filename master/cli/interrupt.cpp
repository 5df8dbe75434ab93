#include "master/cli/interrupt.h"

#include <signal.h>

#include <atomic>

namespace rayfarm {
namespace {

std::atomic<bool> interrupt_seen{false};  // a signal handler can reach nothing but a global
static_assert(std::atomic<bool>::is_always_lock_free, "else a signal handler may not touch it");

extern "C" void note_interrupt(int) { interrupt_seen = true; }

}  // namespace

void note_interrupts() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return interrupt_seen; }

}  // namespace rayfarm
