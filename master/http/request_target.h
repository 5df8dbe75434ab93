// The second word of a request line, taken apart: "/api/v1/jobs/7?after=3".
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rayfarm {

struct RequestTarget {
  std::vector<std::string> path;             // percent-decoded segments; "/" has none
  std::map<std::string, std::string> query;  // decoded; of equal names the last
};

/// Throws std::invalid_argument for what is no path, or has a broken escape or a NUL in it.
RequestTarget parse_target(std::string_view text);

/// Anything but letters, digits and -._~ as %XX, so that it can be a segment.
std::string percent_encoded(std::string_view text);

}  // namespace rayfarm
