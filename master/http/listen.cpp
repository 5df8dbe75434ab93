#include "master/http/listen.h"

#include <unistd.h>

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

tcp::acceptor acceptor_at(asio::io_context& io, const HttpSettings& settings) {
  const tcp::endpoint endpoint = endpoint_of(settings.listen);
  if (!endpoint.address().is_loopback() && !settings.insecure)
    throw HttpError("the HTTP API has no encryption yet, so it listens on loopback only; " + settings.listen +
                    " needs --insecure");
  try {
    return tcp::acceptor(io, endpoint);
  } catch (const boost::system::system_error& error) {
    throw HttpError("cannot listen on " + settings.listen + ": " + error.code().message() +
                    "; choose another address with --http");
  }
}

ListenAddress address_of(const tcp::acceptor& acceptor) {
  const asio::ip::address address = acceptor.local_endpoint().address();
  return {address.to_string(), address.is_loopback(), pc_name()};
}

std::string url_of(const tcp::acceptor& acceptor) {
  const tcp::endpoint endpoint = acceptor.local_endpoint();
  const std::string address = endpoint.address().to_string();
  return "http://" + (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" +
         std::to_string(endpoint.port());
}

}  // namespace rayfarm
