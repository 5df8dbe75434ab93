#include "master/access/credentials.h"

#include <algorithm>
#include <array>
#include <set>

#include "common/net/secrets.h"

namespace rayfarm {
namespace {

constexpr std::array<std::string_view, 4> role_names{"worker", "viewer", "artist", "admin"};
constexpr std::array<std::string_view, 5> kind_names{"pairing code", "certificate", "token", "login link",
                                                     "session"};
constexpr std::size_t most = 20'000;                     // a lab has hundreds
constexpr auto memory_of_ended = std::chrono::days(30);  // as long the log can say what it was

bool is_used_up(const Credential& c) {
  return c.uses_left == 0 && (c.kind == CredentialKind::pairing_code || c.kind == CredentialKind::login_link);
}

/// "pairing code 3f2a91c0"
std::string words_for(const Credential& c) { return std::string(name_of(c.kind)) + " " + c.id; }

std::string new_id() { return base32(random_bytes(5)); }

}  // namespace

std::string_view name_of(Role role) { return role_names.at(static_cast<std::size_t>(role)); }
std::string_view name_of(CredentialKind kind) { return kind_names.at(static_cast<std::size_t>(kind)); }

std::optional<Role> role_named(std::string_view name) {
  const auto found = std::ranges::find(role_names, name);
  if (found == role_names.end()) return std::nullopt;
  return static_cast<Role>(found - role_names.begin());
}

const Credential& Credentials::add(Credential made) {
  if (all_.size() >= most)
    throw AccessRefused("there are " + std::to_string(most) + " tokens, codes and certificates: revoke some");
  made.id = new_id();
  return all_.emplace_back(std::move(made));
}

/// Looks at all of them, so that the time does not tell which one it is.
std::size_t Credentials::find(CredentialKind kind, const std::string& proof, WallTime now) const {
  std::size_t found = all_.size();
  for (std::size_t i = 0; i < all_.size(); ++i)
    if (all_[i].kind == kind && equal_in_constant_time(all_[i].proof, proof)) found = i;
  if (found == all_.size()) throw UnknownSecret("there is no such " + std::string(name_of(kind)));
  const Credential& c = all_[found];
  if (c.is_revoked) throw AccessRefused(words_for(c) + " was revoked");
  if (now >= c.until) throw AccessRefused(words_for(c) + " has expired");
  if (is_used_up(c)) throw AccessRefused(words_for(c) + " was used already");
  return found;
}

Credential Credentials::use(CredentialKind kind, const std::string& proof, WallTime now) {
  Credential& found = all_[find(kind, proof, now)];
  --found.uses_left;
  return found;
}

Credential Credentials::check(CredentialKind kind, const std::string& proof, WallTime now) const {
  return all_[find(kind, proof, now)];
}

bool Credentials::is_name_of_another(const std::string& name, const CertificateFacts& certificate,
                                     WallTime now) const {
  return name != certificate.name && std::ranges::any_of(all_, [&](const Credential& c) {
           return c.kind == CredentialKind::certificate && c.name == name && !c.is_revoked && now < c.until;
         });
}

std::vector<Credential> Credentials::revoke(std::string_view id_or_name) {
  std::set<std::string, std::less<>> ended;
  if (!id_or_name.empty()) ended.emplace(id_or_name);  // what came of a code outlives it
  std::vector<Credential> revoked;
  for (Credential& c : all_) {  // a parent is older than what came of it
    const bool is_named =
        c.id == id_or_name || (c.kind == CredentialKind::certificate && c.name == id_or_name);
    if (!is_named && !ended.contains(c.parent)) continue;
    ended.insert(c.id);
    if (c.is_revoked) continue;
    c.is_revoked = true;
    revoked.push_back(c);
  }
  return revoked;
}

void Credentials::keep_newest_of(const std::string& parent, std::size_t most) {
  const auto is_of_it = [&](const Credential& c) { return c.parent == parent; };
  auto too_many = std::ranges::count_if(all_, is_of_it) - static_cast<std::ptrdiff_t>(most);
  std::erase_if(all_, [&](const Credential& c) { return is_of_it(c) && too_many-- > 0; });
}

void Credentials::forget_ended(WallTime now) {
  std::erase_if(all_, [&](const Credential& c) { return now >= c.until + memory_of_ended; });
}

}  // namespace rayfarm
