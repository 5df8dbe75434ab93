// Ctrl-C as a fact that long work asks for.
#pragma once

namespace rayfarm {

/// From now on the first SIGINT or SIGTERM only sets interrupted(); a second one ends the program at once.
void note_interrupts();
bool interrupted();

}  // namespace rayfarm
