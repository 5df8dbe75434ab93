#include "master/http/guard.h"

#include <arpa/inet.h>

#include <algorithm>

namespace rayfarm {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// "name:port", "name", "[::1]:port": without port and brackets, in small letters.
std::string name_in(const std::string& host) {
  if (host.starts_with('[')) return lower(host.substr(1, host.find(']') - 1));
  return lower(host.substr(0, host.find(':')));
}

bool is_address(const std::string& name) {
  unsigned char bytes[sizeof(in6_addr)];
  return ::inet_pton(AF_INET, name.c_str(), bytes) == 1 || ::inet_pton(AF_INET6, name.c_str(), bytes) == 1;
}

bool is_loopback_address(const std::string& name) {
  in_addr v4{};
  return name == "::1" ||
         (::inet_pton(AF_INET, name.c_str(), &v4) == 1 && ntohl(v4.s_addr) >> 24 == IN_LOOPBACKNET);
}

bool is_loopback_name(const std::string& name) { return name == "localhost" || is_loopback_address(name); }

/// A name can be made to point anywhere, an address cannot: with more than loopback listened to, any address
/// will do.
bool is_ours(const std::string& host, const ListenAddress& listening) {
  const std::string name = name_in(host);
  if (is_loopback_name(name) || name == listening.address) return true;
  if (listening.loopback || name.empty()) return false;
  const std::string pc = lower(listening.pc_name);
  return is_address(name) || (!pc.empty() && (name == pc || name == pc + ".local")) ||
         std::ranges::find(listening.names, name) != listening.names.end();
}

bool is_json(const std::string& content_type) {
  std::string type = lower(content_type.substr(0, content_type.find(';')));
  type.erase(type.find_last_not_of(' ') + 1);
  return type == "application/json";
}

}  // namespace

bool is_from_this_pc(const ApiRequest& request) {
  return is_loopback_address(request.from) && is_loopback_name(name_in(request.host)) &&
         !request.is_forwarded;
}

std::optional<ApiResponse> refusal(const ApiRequest& request, const ListenAddress& listening) {
  if (!is_ours(request.host, listening))
    return error_response(403, "this master does not answer to the name \"" + request.host + "\"");
  const std::string scheme = request.is_encrypted ? "https://" : "http://";
  if (!request.origin.empty() && lower(request.origin) != scheme + lower(request.host))
    return error_response(403, "pages from " + request.origin + " may not use this master");
  const bool from_here =
      request.fetch_site.empty() || request.fetch_site == "same-origin" || request.fetch_site == "none";
  if (!from_here && request.target != "/")  // the bare page holds nothing yet, and may be linked to
    return error_response(403, "pages from elsewhere may not use this master");
  if (request.method == "POST" && !is_json(request.content_type))
    return error_response(415, "POST wants Content-Type: application/json");
  return std::nullopt;
}

}  // namespace rayfarm
