#include "tests/support/own_network.h"

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/ip.h>
#include <netinet/tcp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <vector>

namespace rayfarm {
namespace {

sockaddr inet_address(const std::string& address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  ::inet_pton(AF_INET, address.c_str(), &in.sin_addr);
  sockaddr any{};
  std::memcpy(&any, &in, sizeof any);
  return any;
}

struct Segment {
  std::string way;
  std::uint32_t number = 0;  // of its first byte
  bool is_first = false;
  std::string bytes;
};

std::string end_of(in_addr address, std::uint16_t port) {
  char text[INET_ADDRSTRLEN] = {};
  ::inet_ntop(AF_INET, &address, text, sizeof text);
  return std::string(text) + ":" + std::to_string(ntohs(port));
}

Segment segment_in(std::span<const char> packet) {
  ip head{};
  std::memcpy(&head, packet.data(), sizeof head);
  const std::size_t tcp_at = head.ip_hl * 4u;
  if (head.ip_p != IPPROTO_TCP || packet.size() < tcp_at + sizeof(tcphdr)) return {};
  tcphdr tcp{};
  std::memcpy(&tcp, packet.data() + tcp_at, sizeof tcp);
  const auto content = packet.subspan(tcp_at + tcp.th_off * 4u);
  return {end_of(head.ip_src, tcp.th_sport) + " > " + end_of(head.ip_dst, tcp.th_dport), ntohl(tcp.th_seq),
          (tcp.th_flags & TH_SYN) != 0, std::string(content.begin(), content.end())};
}

}  // namespace

int enter_own_network(const std::string& address) {
  if (::unshare(CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return errno;
  const int control = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq loopback{}, alias{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP | IFF_LOOPBACK | IFF_RUNNING;
  std::strcpy(alias.ifr_name, "lo:1");
  alias.ifr_addr = inet_address(address);
  const bool done =
      ::ioctl(control, SIOCSIFFLAGS, &loopback) == 0 && ::ioctl(control, SIOCSIFADDR, &alias) == 0;
  const int fault = done ? 0 : errno;
  ::close(control);
  return fault;
}

/// Of IP alone, loopback shows each packet once: where it arrives.
PacketCapture::PacketCapture() : socket_(::socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))) {
  const int room = 64 << 20;  // bytes; all of a small render
  if (socket_ < 0) throw std::runtime_error(std::string("cannot capture: ") + std::strerror(errno));
  if (::setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room) != 0)
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
}

PacketCapture::~PacketCapture() { ::close(socket_); }

std::map<std::string, std::string> PacketCapture::streams() {
  std::map<std::string, std::string> streams;
  std::map<std::string, std::uint32_t> next;  // number of the byte that is to come
  std::vector<char> packet(1 << 17);
  for (ssize_t n = 0; (n = ::recv(socket_, packet.data(), packet.size(), MSG_DONTWAIT)) > 0;) {
    const Segment segment = segment_in({packet.data(), static_cast<std::size_t>(n)});
    if (segment.way.empty() || segment.way.find("127.0.0.1:") != std::string::npos) continue;
    if (segment.is_first) next[segment.way] = segment.number + 1, streams[segment.way];
    if (segment.bytes.empty() || segment.number != next[segment.way]) continue;  // nothing, or sent again
    next[segment.way] += static_cast<std::uint32_t>(segment.bytes.size());
    streams[segment.way] += segment.bytes;
  }
  tpacket_stats missed{};
  socklen_t size = sizeof missed;
  ::getsockopt(socket_, SOL_PACKET, PACKET_STATISTICS, &missed, &size);
  if (missed.tp_drops > 0) throw std::runtime_error(std::to_string(missed.tp_drops) + " packets were missed");
  return streams;
}

}  // namespace rayfarm
