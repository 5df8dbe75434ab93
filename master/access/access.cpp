#include "master/access/access.h"

#include "common/net/private_file.h"
#include "master/access/credentials_json.h"
#include "master/access/key_files.h"

namespace rayfarm {
namespace {

constexpr auto certificate_lifetime = std::chrono::years(10);  // revoking ends it, not time
constexpr auto session_lifetime = std::chrono::days(7);
constexpr std::size_t most_sessions = 20;  // with one token

Credentials read(const std::filesystem::path& file) {
  const std::optional<std::string> text = read_private_file(file);
  if (!text) return Credentials();
  try {
    return credentials_in(*text);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + " cannot be read (" + error.what() +
                             "); put back a copy, or remove it and pair all workers again");
  }
}

WallTime in_seconds(WallTime now) { return std::chrono::floor<std::chrono::seconds>(now); }

}  // namespace

Access::Access(const std::filesystem::path& folder, const std::vector<std::string>& hosts, WallTime now)
    : folder_(folder),
      authority_(kept_authority(folder / "authority.pem", now)),
      master_(kept_master(folder / "master.pem", authority_, hosts, now)),
      fingerprint_(fingerprint_of(authority_.certificate)),
      credentials_(read(folder / "credentials.json")) {
  keep_admin_token(now);
}

/// Made anew when it is missing, or no longer good.
void Access::keep_admin_token(WallTime now) {
  const std::filesystem::path file = folder_ / "admin.token";
  const std::optional<std::string> kept = read_private_file(file);
  try {
    if (kept && check_person(kept->substr(0, kept->find('\n')), "", now).role == Role::admin) return;
  } catch (const AccessRefused&) {}
  const Issued made = issue({.kind = CredentialKind::token,
                             .role = Role::admin,
                             .name = "admin.token",
                             .lifetime = std::chrono::years(10)},
                            now);
  write_private_file(file, text_of(made.token) + "\n");
}

/// On the disk first.
void Access::keep(Credentials changed) {
  write_private_file(folder_ / "credentials.json", json_of(changed));
  credentials_ = std::move(changed);
}

/// Counts wrong secrets, and looks at none from where there were too many.
template <class Call>
auto Access::attempt(const std::string& from, WallTime now, Call call) {
  if (!attempts_.are_open_to(from, now)) throw AccessRefused("it was wrong too often just now");
  try {
    return call();
  } catch (const UnknownSecret&) {
    attempts_.count_wrong(from, now);
    throw;
  }
}

Issued Access::issue(const CredentialWish& wish, WallTime now) {
  Issued issued{{}, new_token(fingerprint_)};
  Credential made{.id = {},
                  .kind = wish.kind,
                  .role = wish.role,
                  .name = wish.name,
                  .proof = hash_of_secret(issued.token.secret),
                  .parent = {},
                  .made = in_seconds(now),
                  .until = in_seconds(now) + wish.lifetime,
                  .uses_left = wish.uses};
  const std::lock_guard lock(mutex_);
  Credentials changed = credentials_;
  changed.forget_ended(now);
  issued.credential = changed.add(std::move(made));
  keep(std::move(changed));
  return issued;
}

std::vector<Credential> Access::list() const {
  const std::lock_guard lock(mutex_);
  return credentials_.all();
}

std::vector<Credential> Access::revoke(const std::string& id_or_name) {
  const std::lock_guard lock(mutex_);
  Credentials changed = credentials_;
  std::vector<Credential> revoked = changed.revoke(id_or_name);
  if (!revoked.empty()) keep(std::move(changed));
  return revoked;
}

std::string Access::pair(const Join& asked, const std::string& from, WallTime now) {
  const std::lock_guard lock(mutex_);
  return attempt(from, now, [&] {
    Credentials changed = credentials_;
    const Credential code = changed.use(CredentialKind::pairing_code, hash_of_secret(asked.secret), now);
    const Validity validity{now, now + certificate_lifetime};
    std::string made = issue_certificate(asked, validity);
    changed.add({.id = {},
                 .kind = CredentialKind::certificate,
                 .role = Role::worker,
                 .name = asked.name,
                 .proof = facts_of(made).id,
                 .parent = code.id,
                 .made = in_seconds(now),
                 .until = in_seconds(validity.until)});
    keep(std::move(changed));
    return made;
  });
}

std::string Access::issue_certificate(const Join& asked, const Validity& validity) const try {
  const std::string request(asked.request.begin(), asked.request.end());
  return rayfarm::issue(authority_, request, {PeerRole::worker, asked.name}, validity);
} catch (const CertificateError& error) {
  throw AccessRefused(error.what());
}

void Access::check_worker(const CertificateFacts& certificate, WallTime now) const {
  const std::lock_guard lock(mutex_);
  credentials_.check(CredentialKind::certificate, certificate.id, now);
}

void Access::check_name(const CertificateFacts& certificate, const std::string& name, WallTime now) const {
  const std::lock_guard lock(mutex_);
  if (credentials_.is_name_of_another(name, certificate, now))
    throw AccessRefused("another worker was paired as \"" + name + "\", and this one as \"" +
                        certificate.name + "\": give it a --name of its own, or revoke the other");
}

/// A good one is never shut out: whoever shares its address (a proxy's, this PC's) may be wrong as often as they like.
template <class Look>
auto Access::look_up(const std::string& from, WallTime now, Look look) {
  try {
    return look();
  } catch (const UnknownSecret&) {
    return attempt(from, now, look);
  }
}

Credential Access::check_person(const std::string& shown, const std::string& from, WallTime now) {
  const std::lock_guard lock(mutex_);
  return look_up(from, now, [&] { return known_person(shown, now); });
}

/// Of what a person shows. A browser may still have the cookie of another farm: that is no guess.
std::string Access::proof_in(const std::string& shown) const {
  Token token;
  try {
    token = parse_token(shown);
  } catch (const CodecError&) {
    throw UnknownSecret("this is no token or code");
  }
  if (!fingerprint_.starts_with(token.farm)) throw AccessRefused("this is a token or code of another farm");
  return hash_of_secret(token.secret);
}

Credential Access::known_person(const std::string& shown, WallTime now) const {
  const std::string proof = proof_in(shown);
  try {
    return credentials_.check(CredentialKind::token, proof, now);
  } catch (const UnknownSecret&) {
    return credentials_.check(CredentialKind::session, proof, now);
  }
}

Issued Access::open_session(Credentials changed, const Credential& parent, WallTime until, WallTime now) {
  Issued issued{{}, new_token(fingerprint_)};
  issued.credential = changed.add({.id = {},
                                   .kind = CredentialKind::session,
                                   .role = parent.role,
                                   .name = parent.name,
                                   .proof = hash_of_secret(issued.token.secret),
                                   .parent = parent.id,
                                   .made = in_seconds(now),
                                   .until = std::min(until, in_seconds(now) + session_lifetime)});
  keep(std::move(changed));
  return issued;
}

Issued Access::log_in(const std::string& shown, const std::string& from, WallTime now) {
  const std::lock_guard lock(mutex_);
  return attempt(from, now, [&] {
    Credentials changed = credentials_;
    const Credential link = changed.use(CredentialKind::login_link, proof_in(shown), now);
    return open_session(std::move(changed), link, WallTime::max(), now);
  });
}

Issued Access::log_in_with_token(const std::string& shown, const std::string& from, WallTime now) {
  const std::lock_guard lock(mutex_);
  const Credential token =
      look_up(from, now, [&] { return credentials_.check(CredentialKind::token, proof_in(shown), now); });
  Credentials changed = credentials_;
  changed.keep_newest_of(token.id, most_sessions - 1);
  return open_session(std::move(changed), token, token.until, now);
}

std::optional<Credential> Access::known_session(const std::string& shown, WallTime now) const {
  try {
    return credentials_.check(CredentialKind::session, proof_in(shown), now);
  } catch (const AccessRefused&) {
    return std::nullopt;
  }
}

std::optional<Credential> Access::session(const std::string& shown, WallTime now) const {
  const std::lock_guard lock(mutex_);
  return known_session(shown, now);
}

void Access::log_out(const std::string& shown, WallTime now) {
  const std::lock_guard lock(mutex_);
  const std::optional<Credential> session = known_session(shown, now);
  if (!session) return;
  Credentials changed = credentials_;
  changed.revoke(session->id);
  keep(std::move(changed));
}

}  // namespace rayfarm
