// Who may do what: everything that somebody was given to prove who they are. A value without I/O; time is passed in.
//
//   pairing code   a PC becomes a worker with it, once or several times, soon
//   certificate    what a worker was given for it
//   token          what a person's programs show
//   login link     a browser becomes somebody's with it, once, soon
//   session        the cookie that a browser was given for it, or for a token
// Of what must stay secret only the hash is kept. Revoking one also revokes what it was exchanged for.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/net/certificates.h"

namespace rayfarm {

/// What a person may do, more and more; a worker may nothing of it.
enum class Role : std::uint8_t { worker, viewer, artist, admin };
std::string_view name_of(Role role);
std::optional<Role> role_named(std::string_view name);

enum class CredentialKind : std::uint8_t { pairing_code, certificate, token, login_link, session };
std::string_view name_of(CredentialKind kind);

struct Credential {
  std::string id{};  // 8 letters and digits: names it where the secret must not stand
  CredentialKind kind{};
  Role role{};
  std::string name{};           // of the worker, or what its maker wrote
  std::string proof{};          // hash of the secret; of a certificate its CertificateFacts::id
  std::string parent{};         // id of what it was exchanged for; empty: made by an admin
  WallTime made{}, until{};     // half open
  std::uint32_t uses_left = 0;  // of codes and links
  bool is_revoked = false;
};

/// Why somebody is not let in. For the log, not for them.
struct AccessRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Nobody was given this.
struct UnknownSecret : AccessRefused {
  using AccessRefused::AccessRefused;
};

class Credentials {
 public:
  /// With a new id. Throws AccessRefused when there are too many.
  const Credential& add(Credential made);
  /// Takes one use of a code or link. Throws AccessRefused when there is none, or no more.
  Credential use(CredentialKind kind, const std::string& proof, WallTime now);
  /// What this proves just now. Throws AccessRefused.
  Credential check(CredentialKind kind, const std::string& proof, WallTime now) const;
  /// A worker that was paired under this name may still come, and it is not the one of this certificate, which was
  /// paired under another.
  bool is_name_of_another(const std::string& name, const CertificateFacts& certificate, WallTime now) const;
  /// By id, or the name of a worker; also what came of it. All that was revoked by that.
  std::vector<Credential> revoke(std::string_view id_or_name);
  /// Of those that this was exchanged for only so many stay, the last ones.
  void keep_newest_of(const std::string& parent, std::size_t most);
  /// Forgets what ended long ago.
  void forget_ended(WallTime now);

  const std::vector<Credential>& all() const { return all_; }
  explicit Credentials(std::vector<Credential> all = {}) : all_(std::move(all)) {}

 private:
  std::size_t find(CredentialKind kind, const std::string& proof, WallTime now) const;

  std::vector<Credential> all_;  // in order of making
};

}  // namespace rayfarm
