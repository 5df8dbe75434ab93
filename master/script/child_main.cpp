// rayfarm-script: evaluates one scene script under limits. Started by evaluate(), not by people.
// Standard input: a ScriptTask. Standard output: its reply. Standard error: what the script prints.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "master/files/ending.h"
#include "master/files/texture_image.h"
#include "master/script/confine.h"
#include "master/script/exchange.h"
#include "master/script/run_script.h"

namespace rayfarm {
namespace {

std::string read_all(int fd) {
  std::string all;
  char buffer[65536];
  for (ssize_t n; (n = read(fd, buffer, sizeof buffer)) > 0;) all.append(buffer, static_cast<std::size_t>(n));
  return all;
}

void write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n <= 0) return;  // nobody listens any more
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

bool is_mesh(const std::string& file) { return ending_of(file) == ".obj" || ending_of(file) == ".ply"; }

/// Before the child is confined, and the script runs.
bool needs_images(const ScriptFiles& files) {
  return std::ranges::any_of(files, [](const auto& file) { return !is_mesh(file.first); });
}

std::string reply_to(const ScriptTask& task) {
  // Beside Lua's values: the scene, its bytes, the program itself.
  constexpr std::uint64_t beside_lua = 4ull << 30;
  constexpr std::uint32_t seconds_to_encode = 60;
  if (needs_images(task.files)) prepare_to_read_images();
  confine(task.limits.memory_bytes + beside_lua);
  limit_cpu(task.limits.cpu_seconds + 1);  // a second after the limit from within, which can name the line
  const ScriptReply reply = run_script(task);
  if (const auto* missing = std::get_if<std::vector<std::string>>(&reply)) return encode_wish(*missing);
  limit_cpu(task.limits.cpu_seconds + seconds_to_encode);
  return encode_reply(std::get<ScriptResult>(reply));
}

int run() {
  const ScriptTask task = decode_task(read_all(STDIN_FILENO));
  std::string reply;
  try {
    reply = reply_to(task);
  } catch (const std::bad_alloc&) {
    reply = encode_error(task.request.name + ": not enough memory for the scene");
  } catch (const SceneError& error) {
    reply = encode_error(error.what());
  }
  write_all(STDOUT_FILENO, reply);
  return 0;
}

}  // namespace
}  // namespace rayfarm

int main() {
  try {
    return rayfarm::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rayfarm-script: %s\n", error.what());
    return 1;
  }
}
