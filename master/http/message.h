// A request and its answer, without sockets.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rayfarm {

/// The bytes of an answer: they no longer change, and all who send them share them.
class Body {
 public:
  Body() = default;
  Body(std::string text) { own(std::move(text)); }
  Body(const char* text) : Body(std::string(text)) {}
  Body(std::vector<std::uint8_t> bytes) { own(std::move(bytes)); }
  /// Of bytes that live as long as the program.
  static Body lasting(std::string_view bytes) {
    Body body;
    body.bytes_ = bytes;
    return body;
  }

  std::string_view text() const { return bytes_; }
  const char* data() const { return bytes_.data(); }
  std::size_t size() const { return bytes_.size(); }
  const char* begin() const { return bytes_.data(); }
  const char* end() const { return bytes_.data() + bytes_.size(); }

 private:
  template <class Bytes>
  void own(Bytes&& bytes) {
    const auto owned = std::make_shared<const Bytes>(std::move(bytes));
    bytes_ = {reinterpret_cast<const char*>(owned->data()), owned->size()};
    owner_ = owned;
  }

  std::shared_ptr<const void> owner_;
  std::string_view bytes_;
};

/// How long a browser may keep an answer.
enum class Caching : std::uint8_t { never, ask_again, for_ever };

struct ApiResponse {
  unsigned status = 200;  // 202: not yet; with ?wait=SECONDS the request is tried again until then
  std::string content_type = "application/json";
  Body body;
  Caching caching = Caching::never;
  std::string cookie{};  // to be set; empty: none
};

struct ApiRequest {
  std::string method, target;
  std::string host, origin, fetch_site, content_type;  // header fields; empty: not there
  std::string body;
  std::function<bool()> has_left{};  // whether the asker waits no longer; none: it does

  std::string authorization{}, cookie{};  // header fields
  std::string from{};                     // numeric address of the other end
  std::string our_url{};                  // under which other PCs find the master
  bool is_encrypted = false;
  bool is_forwarded = false;  // somebody else asks through a proxy, which says so

  /// What the asker gets instead when they may no longer what they were let in for; none: they may.
  std::function<std::optional<ApiResponse>()> denial{};
};

/// Requests may wait long for their turn.
inline std::optional<ApiResponse> denial_now(const ApiRequest& request) {
  return request.denial ? request.denial() : std::nullopt;
}

ApiResponse error_response(unsigned status, const std::string& message);

}  // namespace rayfarm
