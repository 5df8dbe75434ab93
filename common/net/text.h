// Text that may be shown on any terminal, log or page.
#pragma once
#include <string_view>

namespace rayfarm {

/// One line of valid UTF-8 (shortest forms, no surrogates) without control characters.
bool is_plain_text(std::string_view text);

}  // namespace rayfarm
