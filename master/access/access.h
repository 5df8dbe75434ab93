// The farm's keys and who it lets in, in the master's state folder. What is changed is on the disk before it counts.
//
//   authority.pem    key and certificate of the farm's authority; made once, it is what workers and browsers trust
//   master.pem       key and certificate of this master, signed by it; made anew when it is old or the PC's name changes
//   credentials.json who was given what: hashes, no secrets
//   admin.token      lets who may read this folder do everything: RAYFARM_TOKEN_FILE
#pragma once
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "common/net/messages.h"
#include "common/net/secrets.h"
#include "master/access/attempts.h"
#include "master/access/credentials.h"

namespace rayfarm {

/// What an admin asks to be made.
struct CredentialWish {
  CredentialKind kind = CredentialKind::pairing_code;  // or token, or login_link
  Role role = Role::worker;
  std::string name{};
  std::uint32_t uses = 1;
  std::chrono::seconds lifetime{3600};
};
/// A credential with the secret that stands for it, which is told this once.
struct Issued {
  Credential credential;
  Token token;
};

/// May be called from any thread. `from` is the address of who asks: the codes that come from one that is wrong too often
/// are not looked at for a minute. What throws AccessRefused says why; for the log only.
class Access {
 public:
  /// Reads what there is, makes what there is not. `hosts`: names and addresses of this PC. Throws std::runtime_error
  /// and CertificateError, with the file's name.
  Access(const std::filesystem::path& folder, const std::vector<std::string>& hosts, WallTime now);

  /// Certificate of the authority.
  const std::string& authority() const { return authority_.certificate; }
  /// Of the master.
  const Identity& identity() const { return master_; }
  std::string fingerprint() const { return fingerprint_; }

  Issued issue(const CredentialWish& wish, WallTime now);
  std::vector<Credential> list() const;
  /// By id, or the name of a worker. All that was revoked by that.
  std::vector<Credential> revoke(const std::string& id_or_name);

  /// The certificate of a new worker. Throws AccessRefused.
  std::string pair(const Join& asked, const std::string& from, WallTime now);
  /// The worker that has this certificate may come. Throws AccessRefused.
  void check_worker(const CertificateFacts& certificate, WallTime now) const;
  /// It may call itself that: nobody else was paired under this name. Throws AccessRefused.
  void check_name(const CertificateFacts& certificate, const std::string& name, WallTime now) const;
  /// Who shows this token, or cookie. Throws AccessRefused.
  Credential check_person(const std::string& shown, const std::string& from, WallTime now);

  // Sessions of browsers: what they show is their cookie.
  /// For who comes with the code of a login link. Throws AccessRefused.
  Issued log_in(const std::string& shown, const std::string& from, WallTime now);
  /// For who has a token, no longer than that is good. Beyond 20 of them the first ends. Throws AccessRefused.
  Issued log_in_with_token(const std::string& shown, const std::string& from, WallTime now);
  /// Nothing when it is none, or none any more.
  std::optional<Credential> session(const std::string& shown, WallTime now) const;
  /// Ends it, if it is one. A token stays good, whoever shows it.
  void log_out(const std::string& shown, WallTime now);

 private:
  void keep(Credentials changed);
  void keep_admin_token(WallTime now);
  std::string issue_certificate(const Join& asked, const Validity& validity) const;
  std::string proof_in(const std::string& shown) const;
  Credential known_person(const std::string& shown, WallTime now) const;
  std::optional<Credential> known_session(const std::string& shown, WallTime now) const;
  Issued open_session(Credentials changed, const Credential& parent, WallTime until, WallTime now);
  template <class Call>
  auto attempt(const std::string& from, WallTime now, Call call);
  template <class Look>
  auto look_up(const std::string& from, WallTime now, Look look);

  const std::filesystem::path folder_;
  Identity authority_, master_;
  std::string fingerprint_;

  mutable std::mutex mutex_;  // guards what follows
  Credentials credentials_;
  Attempts attempts_;
};

}  // namespace rayfarm
