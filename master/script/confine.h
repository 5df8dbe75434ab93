// The limits that the script's child process puts on itself before it looks at the script.
#pragma once
#include <cstdint>

namespace rayfarm {

/// From here on the process can open no file and no socket, write no file, start no program and dump no core;
/// its address space is bounded, and it dies with its parent. Throws std::system_error when the system
/// refuses.
void confine(std::uint64_t address_space_bytes);

/// The process is killed once it has used so much processor time. May be raised again.
void limit_cpu(std::uint32_t seconds);

}  // namespace rayfarm
