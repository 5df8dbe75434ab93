// Requests and answers as Beast has them, and as the API has them.
#pragma once
#include <boost/beast/http.hpp>
#include <optional>

#include "master/http/message.h"

namespace rayfarm {

using RequestParser = boost::beast::http::request_parser<boost::beast::http::string_body>;
using Response = boost::beast::http::response<boost::beast::http::span_body<const char>>;

/// Without its body, and what only the connection knows.
ApiRequest api_request(const RequestParser::value_type& message);
/// The head of an answer, and a view of its body.
Response http_response(const ApiResponse& answer, const RequestParser::value_type& request, bool keep_alive);
/// How much the peer may still send: what it announced, or the limit when it did not.
std::uint64_t expected_body(const RequestParser& parser, std::uint64_t limit);
/// What a request that cannot be read deserves; nothing when the peer is gone or silent.
std::optional<ApiResponse> complaint(const boost::system::error_code& error, std::uint64_t body_limit);

}  // namespace rayfarm
