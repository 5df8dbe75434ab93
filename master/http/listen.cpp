#include "master/http/listen.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>

namespace rayfarm {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

tcp::endpoint endpoint_of(const std::string& listen) {
  const HttpError wrong("--http wants ADDRESS:PORT, as in 127.0.0.1:5412 or [::1]:5412, is " + listen);
  const std::size_t colon = listen.rfind(':');
  if (colon == std::string::npos) throw wrong;
  std::string address = listen.substr(0, colon);
  if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
  if (address == "localhost") address = "127.0.0.1";

  std::uint16_t port = 0;
  const char *begin = listen.data() + colon + 1, *end = listen.data() + listen.size();
  const auto [stop, error] = std::from_chars(begin, end, port);
  boost::system::error_code no_address;
  const asio::ip::address parsed = asio::ip::make_address(address, no_address);
  if (error != std::errc{} || stop != end || no_address) throw wrong;
  return {parsed, port};
}

std::string pc_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

}  // namespace

asio::ip::address peer_address(const tcp::socket& socket) {
  const asio::ip::address address = socket.remote_endpoint().address();
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

tcp::acceptor acceptor_at(asio::io_context& io, const HttpSettings& settings) {
  const tcp::endpoint endpoint = endpoint_of(settings.listen);
  if (!settings.identity && !allows_plaintext(settings, endpoint.address()))
    throw HttpError(
        "there is no certificate to encrypt the HTTP API with at " + settings.listen +
        ": give the master --state FOLDER (or --insecure, if everybody on the network may do everything)");
  try {
    return tcp::acceptor(io, endpoint);
  } catch (const boost::system::system_error& error) {
    throw HttpError("cannot listen on " + settings.listen + ": " + error.code().message() +
                    "; choose another address with --http");
  }
}

bool allows_plaintext(const HttpSettings& settings, const asio::ip::address& with) {
  return settings.exposure == Exposure::insecure ||
         (settings.exposure == Exposure::loopback_only && with.is_loopback());
}

ListenAddress address_of(const tcp::acceptor& acceptor, const HttpSettings& settings) {
  const asio::ip::address address = acceptor.local_endpoint().address();
  ListenAddress listening{address.to_string(), address.is_loopback(), pc_name(), {}};
  if (settings.identity)
    for (std::string name : facts_of(settings.identity->certificate).hosts) {
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
      listening.names.push_back(std::move(name));
    }
  return listening;
}

static std::string url_at(const asio::ip::address& host, const tcp::acceptor& acceptor,
                          const HttpSettings& settings) {
  const std::string address = host.to_string();
  const bool is_plain = allows_plaintext(settings, acceptor.local_endpoint().address());
  return (is_plain ? "http://" : "https://") + (host.is_v6() ? "[" + address + "]" : address) + ":" +
         std::to_string(acceptor.local_endpoint().port());
}

std::string url_of(const tcp::acceptor& acceptor, const HttpSettings& settings) {
  return url_at(acceptor.local_endpoint().address(), acceptor, settings);
}

std::string outward_url_of(const tcp::acceptor& acceptor, const HttpSettings& settings) {
  const asio::ip::address listening = acceptor.local_endpoint().address();
  return url_at(listening.is_unspecified() ? asio::ip::make_address(settings.outward_host) : listening,
                acceptor, settings);
}

}  // namespace rayfarm
