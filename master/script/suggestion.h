// "Did you mean": the known name nearest to a misspelt one.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace rayfarm {

/// ", did you mean 'sphere'?" or, when no candidate is near, nothing. Ready to be appended to a message.
std::string suggestion(std::string_view misspelt, const std::vector<std::string>& candidates);

}  // namespace rayfarm
