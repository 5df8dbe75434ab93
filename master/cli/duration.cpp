#include "master/cli/duration.h"

#include <charconv>

#include "master/cli/exit_code.h"

namespace rayfarm {

std::uint64_t seconds_in(const std::string& text) {
  std::uint32_t count = 0;
  const auto [unit, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const std::string_view rest(unit, static_cast<std::size_t>(text.data() + text.size() - unit));
  const std::uint64_t seconds = rest == "s"   ? 1
                                : rest == "m" ? 60
                                : rest == "h" ? 3600
                                : rest == "d" ? 86'400
                                              : 0;
  if (error != std::errc{} || seconds == 0 || count == 0)
    throw CommandError(ExitCode::usage, "\"" + text + "\" is no length of time: write 90s, 30m, 1h or 7d");
  return count * seconds;
}

}  // namespace rayfarm
