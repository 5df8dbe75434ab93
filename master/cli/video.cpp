#include "master/cli/video.h"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/render/settings.h"
#include "master/files/ending.h"
#include "master/files/image_file.h"

extern char** environ;

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kinds{".mp4", ".mkv", ".mov", ".webm", ".avi", ".gif"};

/// Empty when it is not there.
std::string program_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/" + name;
    if (!folder.empty() && ::access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

FileError no_video(const std::string& file, const std::string& why) {
  return FileError("cannot write the video " + file + ": " + why);
}

/// A program that reads what it is given on its standard input.
class Reader {
 public:
  Reader(const std::string& program, std::vector<std::string> arguments) {
    int ends[2];
    // A socket rather than a pipe: a write to a dead program must not raise SIGPIPE here.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw FileError(std::strerror(errno));
    to_program_ = ends[0];
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[1], 0);
    arguments.insert(arguments.begin(), program);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const int error = posix_spawn(&pid_, program.c_str(), &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[1]);
    if (error == 0) return;
    ::close(to_program_);
    throw FileError(program + ": " + std::strerror(error));
  }
  ~Reader() { end(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// False when it reads no more.
  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::send(to_program_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  /// Whether it ended well, once it has.
  bool end() {
    if (pid_ == 0) return ended_well_;
    ::close(to_program_);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {}
    pid_ = 0;
    return ended_well_ = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  int to_program_ = -1;
  pid_t pid_ = 0;
  bool ended_well_ = false;
};

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

}  // namespace

void check_video(const std::string& file, const std::string& pictures) {
  if (program_in_path("ffmpeg").empty())
    throw SettingsError("--video needs ffmpeg, which is not in the PATH: install it (apt install ffmpeg)");
  if (ending_of(pictures) != ".png")
    throw SettingsError("--video is made of .png pictures; let -o end in .png");
  if (std::ranges::find(kinds, ending_of(file)) == kinds.end())
    throw SettingsError("--video cannot tell the kind of video from the name " + file +
                        "; let it end in .mp4, .mkv, .mov, .webm, .avi or .gif");
  check_place(file);
}

void write_video(const std::string& file, const std::vector<std::string>& pictures,
                 double frames_per_second) {
  const fs::path path(file);
  const fs::path beside =  // with the same extension, by which ffmpeg knows the kind of video
      path.parent_path() / ("." + std::to_string(::getpid()) + "-" + path.filename().string());
  bool is_written = false;
  {
    Reader ffmpeg(program_in_path("ffmpeg"),
                  {"-loglevel", "error", "-y", "-f", "image2pipe", "-c:v", "png", "-framerate",
                   std::to_string(frames_per_second), "-i", "pipe:0",
                   // Most players want even sides and this form of pixels.
                   "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", beside.string()});
    bool reads = true;
    for (const std::string& picture : pictures) reads = reads && ffmpeg.write(content_of(picture));
    is_written = ffmpeg.end() && reads;
  }
  std::error_code failed;
  if (is_written) fs::rename(beside, path, failed);
  if (is_written && !failed) return;
  std::error_code ignored;
  fs::remove(beside, ignored);
  throw no_video(file, is_written ? failed.message() : "ffmpeg failed");
}

}  // namespace rayfarm
