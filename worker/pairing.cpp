#include "worker/pairing.h"

#include <unistd.h>

#include <cstdlib>

#include "common/net/messages.h"
#include "common/net/private_file.h"

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

constexpr const char* file_name = "pairing.pem";
constexpr std::string_view master_line = "master ";

Pairing pairing_in(const std::string& text) {
  const std::vector<std::string> blocks = pem_blocks(text);
  if (!text.starts_with(master_line) || blocks.size() != 3)
    throw CertificateError("it does not name a master and hold a key and two certificates");
  Pairing pairing{{blocks[0], blocks[1]}, blocks[2], {}};
  const std::size_t end = text.find('\n');
  pairing.master =
      parse_address(text.substr(master_line.size(), end - master_line.size()), default_farm_port);
  if (!is_of_key(pairing.own.certificate, pairing.own.key))
    throw CertificateError("the key is another one's");
  return pairing;
}

}  // namespace

std::optional<Pairing> read_pairing(const fs::path& state) {
  const fs::path file = state / file_name;
  const std::optional<std::string> text = read_private_file(file);
  if (!text) return std::nullopt;
  try {
    return pairing_in(*text);
  } catch (const std::runtime_error& error) {
    throw CertificateError(file.string() + " cannot be used (" + error.what() +
                           "); pair this PC again: rayfarm-worker join CODE");
  }
}

void make_room_for_pairing(const fs::path& state) try {
  const fs::path trial = state / "pairing.trial";
  fs::create_directories(state);
  write_private_file(trial, std::string(8192, ' '));  // more than a pairing takes
  fs::remove(trial);
} catch (const std::exception& error) {
  throw std::runtime_error("the keys could not be kept in " + state.string() + " (" + error.what() +
                           "), so the code was not used: choose another folder with --state");
}

void write_pairing(const fs::path& state, const Pairing& pairing) {
  write_private_file(state / file_name, std::string(master_line) + text_of(pairing.master) + "\n" +
                                            pairing.own.key + pairing.own.certificate + pairing.authority);
}

fs::path default_worker_state() {
  if (::geteuid() == 0) return "/var/lib/rayfarm-worker";
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state && *state == '/') return fs::path(state) / "rayfarm-worker";
  const char* home = std::getenv("HOME");
  return fs::path(home && *home == '/' ? home : ".") / ".local/state/rayfarm-worker";
}

}  // namespace rayfarm
