// The files of the web page and of the API's description, built into the program.
#pragma once
#include <string_view>

namespace rayfarm {

extern const std::string_view index_html, app_js, style_css, openapi_json;

}  // namespace rayfarm
