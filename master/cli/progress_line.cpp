#include "master/cli/progress_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "master/cli/text.h"

namespace rayfarm {
namespace {

constexpr auto redraw_interval = std::chrono::milliseconds(100);
constexpr auto line_interval = std::chrono::seconds(1);  // what is quick needs no lines

int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool can_redraw() {
  const char* terminal = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

}  // namespace

std::string progress_text(double fraction, const std::string& details,
                          std::optional<std::chrono::seconds> eta, int columns) {
  const double part = std::clamp(fraction, 0.0, 1.0);
  std::string end = " " + std::to_string(static_cast<int>(100 * part)) + "%  " + details;
  if (eta) end += "  ETA " + clock_text(*eta);
  const int room = std::min(30, columns - static_cast<int>(end.size()) - 3);
  if (room < 5) return end.substr(1);
  const auto filled = static_cast<std::size_t>(part * room);
  return "[" + std::string(filled, '#') + std::string(static_cast<std::size_t>(room) - filled, '.') + "]" +
         end;
}

ProgressLine::ProgressLine() : on_terminal_(can_redraw()), last_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(double fraction, const std::string& details,
                        std::optional<std::chrono::seconds> eta) {
  const auto now = std::chrono::steady_clock::now();
  if (!on_terminal_) {
    const int tenth = static_cast<int>(10 * fraction);
    if (tenth <= last_tenth_ || now - last_ < line_interval) return;
    last_ = now, last_tenth_ = tenth;
    std::fprintf(stderr, "%s\n", progress_text(fraction, details, eta, 0).c_str());
    return;
  }
  if (drawn_ && now - last_ < redraw_interval) return;
  last_ = now, drawn_ = true;
  std::fprintf(stderr, "\r%s\033[K", progress_text(fraction, details, eta, terminal_columns()).c_str());
}

void ProgressLine::say(const std::string& text) {
  if (text == said_) return;
  said_ = text;
  if (text.empty()) return;
  std::fprintf(stderr, "%s%s\n", drawn_ ? "\r\033[K" : "", text.c_str());
  drawn_ = false;
}

}  // namespace rayfarm
