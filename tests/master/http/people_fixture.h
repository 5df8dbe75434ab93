// A master with keys, and people who ask.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

#include "master/http/client.h"
#include "tests/support/raw_peer.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_server.h"

namespace rayfarm {

inline const WallTime now = std::chrono::system_clock::now();

struct People : testing::Test {
  ScratchFolder folder;
  Access access{folder.path(), {"localhost", "127.0.0.1"}, now};
  FarmThread farm;
  std::mutex mutex;
  std::vector<std::string> told, noted;  // refusals; what was done

  /// A line with these words is among them.
  bool has_line(const std::vector<std::string>& lines, std::string_view words) {
    const std::lock_guard lock(mutex);
    return std::ranges::any_of(lines, [&](const auto& line) { return line.find(words) != line.npos; });
  }

  Identity identity() const {
    return {access.identity().key, access.identity().certificate + access.authority()};
  }
  HttpSettings settings(Exposure exposure) const {
    return {.listen = "127.0.0.1:0", .exposure = exposure, .identity = identity()};
  }
  MasterDoor master() {
    MasterDoor door = lone_master();
    door.tell = [this](const std::string& line) {
      const std::lock_guard lock(mutex);
      told.push_back(line);
    };
    door.note = [this](const std::string& line) {
      const std::lock_guard lock(mutex);
      noted.push_back(line);
    };
    return door;
  }
  std::string token(Role role) {
    return text_of(access.issue({.kind = CredentialKind::token, .role = role}, now).token);
  }
};

inline unsigned status_of(const std::string& url, const std::string& method, const std::string& target,
                          const std::string& token) {
  return send({.method = method, .url = url, .target = target, .body = "{}", .token = token}).status;
}

inline bool is_status(const std::string& answer, int status) {
  return answer.starts_with("HTTP/1.1 " + std::to_string(status));
}

}  // namespace rayfarm
