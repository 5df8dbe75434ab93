// Text that may be shown on any terminal, log or page.
#pragma once
#include <string_view>

namespace rayfarm {

/// Valid UTF-8 (shortest forms, no surrogates) without control characters other than tab and newline.
bool is_plain_text(std::string_view text);

}  // namespace rayfarm
