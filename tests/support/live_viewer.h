// A viewer on the live connection that waits for what it is sent.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace rayfarm {

/// The master ended the connection, or refused it; the message is its reason, if it gave one.
struct ViewerEnded : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class LiveViewer {
 public:
  struct Message {
    bool is_text = true;
    std::vector<std::uint8_t> bytes;
  };

  /// Throws ViewerEnded with the status, "403 Forbidden", when it is refused. `header`: fields beside the usual.
  explicit LiveViewer(std::uint16_t port, const std::map<std::string, std::string>& header = {});
  ~LiveViewer();

  void say(const std::string& text);
  /// The next message, once it has come. Throws ViewerEnded.
  Message next();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// How many files and sockets this process has open.
std::size_t open_descriptors();
/// Memory of this process in bytes, as it really lies in RAM.
std::uint64_t resident_memory();

}  // namespace rayfarm
