#include "common/daemon/system.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <set>

#ifdef RAYFARM_SYSTEMD
#include <systemd/sd-daemon.h>
#endif

namespace rayfarm {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unnamed";
}

namespace {

/// Empty for what is no address that browsers could use.
std::string text_of(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address && address->sa_family == AF_INET) {
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(address)->sin_addr, text.data(), text.size());
  } else if (address && address->sa_family == AF_INET6) {
    const in6_addr& v6 = reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
    if (!IN6_IS_ADDR_LINKLOCAL(&v6)) inet_ntop(AF_INET6, &v6, text.data(), text.size());
  }
  return text.data();
}

}  // namespace

std::vector<std::string> own_hosts() {
  std::set<std::string> hosts{"localhost", "127.0.0.1", "::1", host_name(), host_name() + ".local"};
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) == 0)
    for (const ifaddrs* one = all; one; one = one->ifa_next) hosts.insert(text_of(one->ifa_addr));
  freeifaddrs(all);
  hosts.erase("");
  return {hosts.begin(), hosts.end()};
}

/// The route to an address that no packet ever reaches (RFC 5737); nothing is sent.
std::string outward_address() {
  sockaddr_in far{}, near{};
  far.sin_family = AF_INET, far.sin_port = htons(9);
  inet_pton(AF_INET, "192.0.2.1", &far.sin_addr);
  socklen_t size = sizeof near;
  const int route = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool is_known = route >= 0 &&
                        connect(route, reinterpret_cast<const sockaddr*>(&far), sizeof far) == 0 &&
                        getsockname(route, reinterpret_cast<sockaddr*>(&near), &size) == 0;
  if (route >= 0) close(route);
  return is_known ? text_of(reinterpret_cast<const sockaddr*>(&near)) : "127.0.0.1";
}

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "";
}

void allow_many_descriptors() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // what there was stays when this is refused
}

#ifdef RAYFARM_SYSTEMD
void notify_ready() { sd_notify(0, "READY=1"); }
void notify_stopping() { sd_notify(0, "STOPPING=1"); }
#else
void notify_ready() {}
void notify_stopping() {}
#endif

}  // namespace rayfarm
