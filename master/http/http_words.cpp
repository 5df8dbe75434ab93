#include "master/http/http_words.h"

namespace rayfarm {

namespace http = boost::beast::http;

namespace {

bool is_forwarded(const RequestParser::value_type& message) {
  for (const char* field : {"Forwarded", "X-Forwarded-For", "X-Forwarded-Host", "X-Real-IP", "Via"})
    if (message.count(field) > 0) return true;
  return false;
}

}  // namespace

ApiRequest api_request(const RequestParser::value_type& message) {
  const auto field = [&](std::string_view name) { return std::string(message[name]); };
  const bool is_head = message.method() == http::verb::head;  // as GET, but for the body: RFC 9110, 9.3.2
  return {is_head ? "GET" : std::string(message.method_string()),
          std::string(message.target()),
          field("Host"),
          field("Origin"),
          field("Sec-Fetch-Site"),
          field("Content-Type"),
          "",
          {},
          field("Authorization"),
          field("Cookie"),
          "",
          "",
          false,
          is_forwarded(message)};
}

namespace {

std::string_view words_of(Caching caching) {
  if (caching == Caching::for_ever) return "public, max-age=31536000, immutable";
  return caching == Caching::ask_again ? "no-cache" : "no-store";
}

}  // namespace

Response http_response(const ApiResponse& answer, const RequestParser::value_type& request, bool keep_alive) {
  Response response(static_cast<http::status>(answer.status), request.version());
  response.body() = {answer.body.data(), answer.body.size()};
  response.set(http::field::server, "rayfarm");
  response.set(http::field::content_type, answer.content_type);
  response.set(http::field::cache_control, words_of(answer.caching));
  if (!answer.cookie.empty()) response.set(http::field::set_cookie, answer.cookie);
  if (answer.status == 401) response.set(http::field::www_authenticate, "Bearer");  // RFC 9110, 15.5.2
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
               "connect-src 'self'; "
               "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
  response.set("Referrer-Policy", "no-referrer");
  response.keep_alive(keep_alive);
  response.prepare_payload();
  return response;
}

std::uint64_t expected_body(const RequestParser& parser, std::uint64_t limit) {
  return parser.chunked() ? limit : parser.content_length_remaining().value_or(0);
}

std::optional<ApiResponse> complaint(const boost::system::error_code& error, std::uint64_t body_limit) {
  if (error == http::error::header_limit) return error_response(431, "the header is over 8 KB");
  if (error == http::error::body_limit)
    return error_response(
        413, "the body is too large: at most " + std::to_string(body_limit) + " bytes may come here");
  if (error == http::error::end_of_stream || error == http::error::partial_message) return std::nullopt;
  if (error.category() == make_error_code(http::error::bad_method).category())
    return error_response(400, "this is no HTTP request: " + error.message());
  return std::nullopt;
}

}  // namespace rayfarm
