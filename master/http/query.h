// What a request asks for beside its path: "?reduce=mean&compat=1". Each throws ApiError with the name and what it
// may be.
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "master/http/route.h"

namespace rayfarm {

/// Throws unless all names in the query are among the known ones: a misspelt one would be left out in silence.
void expect_known(const std::map<std::string, std::string>& query,
                  const std::map<std::string, std::string>& known);

struct WholeRange {
  std::uint32_t low = 0, high = std::numeric_limits<std::uint32_t>::max();  // both are in it
};

/// Nothing when it is not there.
std::optional<std::string> text_in(const Call& call, const std::string& name);
std::optional<double> real_in(const Call& call, const std::string& name);
std::optional<std::uint32_t> whole_in(const Call& call, const std::string& name, WholeRange range = {});
/// 0 (also when it is not there) or 1.
bool switch_in(const Call& call, const std::string& name);

/// What choice_named(text), an optional, makes of it.
template <class ChoiceNamed>
auto choice_in(const Call& call, const std::string& name, const std::string& otherwise,
               const std::string& choices, ChoiceNamed choice_named) {
  const std::string text = text_in(call, name).value_or(otherwise);
  const auto choice = choice_named(text);
  if (!choice) throw ApiError(400, name + " must be " + choices + ", is " + text);
  return *choice;
}

/// The answer while it is being made: 202.
ApiResponse in_the_making(double progress);

}  // namespace rayfarm
