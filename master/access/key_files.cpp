#include "master/access/key_files.h"

#include <algorithm>
#include <optional>

#include "common/net/private_file.h"

namespace rayfarm {
namespace {

constexpr auto master_lifetime = std::chrono::days(820);

std::optional<Identity> read_identity(const std::filesystem::path& file) {
  const std::optional<std::string> text = read_private_file(file);
  if (!text) return std::nullopt;
  const std::vector<std::string> blocks = pem_blocks(*text);
  try {
    if (blocks.size() != 2 || !is_of_key(blocks[1], blocks[0]))
      throw CertificateError("the two do not match");
    return Identity{blocks[0], blocks[1]};
  } catch (const CertificateError& error) {
    throw CertificateError(file.string() + " does not hold a key and its certificate (" + error.what() +
                           "); put back a copy, or remove it and pair all workers again");
  }
}

void write(const std::filesystem::path& file, const Identity& identity) {
  write_private_file(file, identity.key + identity.certificate);
}

}  // namespace

Identity kept_authority(const std::filesystem::path& file, WallTime now) {
  if (const std::optional<Identity> kept = read_identity(file)) {
    if (facts_of(kept->certificate).from > now)
      throw CertificateError(
          file.string() +
          " was made when the clock of this PC was ahead, or it is behind now: set the clock, "
          "or remove that file and pair all workers again");
    return *kept;
  }
  Identity made = new_authority(now);
  write(file, made);
  return made;
}

Identity kept_master(const std::filesystem::path& file, const Identity& authority,
                     std::vector<std::string> hosts, WallTime now) {
  std::ranges::sort(hosts);
  const auto is_good = [&](const Identity& kept) {
    const CertificateFacts facts = facts_of(kept.certificate);
    return is_signed_by(kept.certificate, authority.certificate) && facts.hosts == hosts &&
           facts.from <= now && facts.until > now + master_lifetime / 2;
  };
  if (const std::optional<Identity> kept = read_identity(file); kept && is_good(*kept)) return *kept;
  const std::string key = new_key();
  Identity made{key, issue(authority, certificate_request(key), {PeerRole::master, "rayfarm master", hosts},
                           {now, now + master_lifetime})};
  write(file, made);
  return made;
}

}  // namespace rayfarm
