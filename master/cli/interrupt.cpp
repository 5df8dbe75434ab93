#include "master/cli/interrupt.h"

#include <signal.h>

namespace rayfarm {
namespace {

volatile sig_atomic_t interrupt_seen = 0;  // a signal handler can reach nothing but a global

extern "C" void note_interrupt(int) { interrupt_seen = 1; }

}  // namespace

void note_interrupts() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return interrupt_seen != 0; }

}  // namespace rayfarm
