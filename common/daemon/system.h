// What a daemon knows of the PC that it runs on, and tells the service manager.
#pragma once
#include <string>
#include <vector>

namespace rayfarm {

std::string host_name();
/// Under which this PC can be found: its names, localhost, and its numeric addresses but for link-local ones.
std::vector<std::string> own_hosts();
/// The address under which other PCs most likely reach this one; loopback's when it has no other.
std::string outward_address();
/// As the kernel names it; empty where it does not.
std::string cpu_name();

/// As many open files and connections as the system lets this process have.
void allow_many_descriptors();

/// Tell systemd, if it started us (and we were built with it).
void notify_ready();
void notify_stopping();

}  // namespace rayfarm
