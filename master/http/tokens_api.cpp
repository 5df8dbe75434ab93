// Codes, tokens and certificates: making, listing, revoking.
#include <array>
#include <ctime>
#include <nlohmann/json.hpp>
#include <set>

#include "common/net/text.h"
#include "master/access/access.h"
#include "master/http/route.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr std::uint32_t most_uses = 10'000;
constexpr std::uint64_t longest_ttl = 10ull * 365 * 24 * 3600;  // seconds

Access& access_of(const Call& call) {
  if (!call.doors.access)
    throw ApiError(409, "this master keeps no keys: start it with --state FOLDER to have codes and tokens");
  return *call.doors.access;
}

/// 2026-11-22T09:30:00Z
std::string time_text(WallTime time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

/// token 3f2a91c0 ("Ada", artist)
std::string words_for(const Credential& c) {
  return std::string(name_of(c.kind)) + " " + c.id + " (" + (c.name.empty() ? "" : '"' + c.name + "\", ") +
         std::string(name_of(c.role)) + ")";
}

std::string_view state_of(const Credential& c, WallTime now) {
  if (c.is_revoked) return "revoked";
  if (now >= c.until) return "expired";
  const bool is_counted = c.kind == CredentialKind::pairing_code || c.kind == CredentialKind::login_link;
  return is_counted && c.uses_left == 0 ? "used" : "good";
}

json to_json(const Credential& c, WallTime now) {
  return {{"id", c.id},
          {"kind", name_of(c.kind)},
          {"role", name_of(c.role)},
          {"name", c.name},
          {"state", state_of(c, now)},
          {"uses_left", c.uses_left},
          {"made", time_text(c.made)},
          {"until", time_text(c.until)},
          {"parent", c.parent}};
}

std::uint64_t number_member(const json& body, const char* name, std::uint64_t otherwise, std::uint64_t most) {
  if (!body.contains(name)) return otherwise;
  const json& value = body[name];
  if (!value.is_number_unsigned() || value == 0 || value > most)
    throw ApiError(422, std::string(name) + " is a whole number from 1 to " + std::to_string(most) +
                            ", not " + value.dump());
  return value;
}

std::string text_member(const json& body, const char* name) {
  if (!body.contains(name)) return "";
  const json& value = body[name];
  if (!value.is_string()) throw ApiError(422, std::string(name) + " cannot be " + value.dump());
  if (const std::string text = value; text.size() <= max_owner_name && is_plain_text(text)) return text;
  throw ApiError(422, std::string(name) + " is one line of at most 64 bytes without control characters");
}

/// A pairing code is for an hour, a login link for ten minutes, a token for three months.
std::uint64_t usual_ttl(CredentialKind kind) {
  using namespace std::chrono_literals;
  const std::chrono::seconds usual = kind == CredentialKind::pairing_code ? 1h
                                     : kind == CredentialKind::login_link ? 10min
                                                                          : 90 * 24h;
  return static_cast<std::uint64_t>(usual.count());
}

CredentialWish wish_in(const json& body) {
  for (const auto& [name, value] : body.items())
    if (name != "role" && name != "uses" && name != "ttl" && name != "name" && name != "link")
      throw ApiError(400, "there is no \"" + name + "\": a token has role, uses, ttl, name and link");
  const std::string role_name = body.contains("role") ? text_member(body, "role") : "worker";
  const std::optional<Role> role = role_named(role_name);
  if (!role) throw ApiError(422, "role is worker, viewer, artist or admin, not " + role_name);
  if (body.contains("link") && !body["link"].is_boolean()) throw ApiError(422, "link is true or false");
  const bool is_link = body.value("link", false);
  if (is_link && role == Role::worker) throw ApiError(422, "a worker has no browser: a link is for people");
  CredentialWish wish;
  wish.kind = is_link                ? CredentialKind::login_link
              : role == Role::worker ? CredentialKind::pairing_code
                                     : CredentialKind::token;
  wish.role = *role;
  wish.name = text_member(body, "name");
  wish.uses = static_cast<std::uint32_t>(number_member(body, "uses", 1, most_uses));
  if (wish.uses != 1 && wish.kind != CredentialKind::pairing_code)
    throw ApiError(422, is_link ? "a login link is good once: make one for each browser"
                                : "a token is good until it ends: uses is for the codes of workers");
  wish.lifetime = std::chrono::seconds(number_member(body, "ttl", usual_ttl(wish.kind), longest_ttl));
  return wish;
}

ApiResponse make_token(const Call& call) {
  Access& access = access_of(call);
  const CredentialWish wish = wish_in(body_of(call));
  const WallTime now = std::chrono::system_clock::now();
  const Issued issued = access.issue(wish, now);
  call.doors.master.note(words_for(issued.credential) + " was made at " + call.request.from);
  json answer = to_json(issued.credential, now);
  answer["token"] = text_of(issued.token);
  answer["authority"] = access.fingerprint();
  if (wish.kind == CredentialKind::pairing_code) answer["master"] = call.doors.master.farm_address;
  // After #, so that it stands in no server's log and nobody fetches it.
  if (wish.kind == CredentialKind::login_link)
    answer["link"] = call.request.our_url + "/#/login/" + text_of(issued.token);
  return {201, "application/json", answer.dump()};
}

ApiResponse list_tokens(const Call& call) {
  const WallTime now = std::chrono::system_clock::now();
  json tokens = json::array();
  for (const Credential& c : access_of(call).list()) tokens.push_back(to_json(c, now));
  return shown({{"tokens", std::move(tokens)}});
}

ApiResponse revoke_token(const Call& call) {
  const std::string& name = call.arguments.at(0);
  const std::vector<Credential> revoked = access_of(call).revoke(name);
  if (revoked.empty())
    throw ApiError(404, "there is no code, token or paired worker " + name + " that is not revoked already");
  std::set<std::string> certificates;
  for (const Credential& c : revoked)
    if (c.kind == CredentialKind::certificate) certificates.insert(c.proof);
  call.doors.farm.ask([&master = call.doors.master, certificates](Farm&, FarmTime) {
    master.cut_off(certificates);
    return true;
  });
  const WallTime now = std::chrono::system_clock::now();
  json answer = json::array();
  for (const Credential& c : revoked) {
    call.doors.master.note(words_for(c) + " was revoked at " + call.request.from);
    answer.push_back(to_json(c, now));
  }
  return shown({{"revoked", std::move(answer)}});
}

ApiResponse show_authority(const Call& call) {
  return {200, "application/x-pem-file", access_of(call).authority()};
}

constexpr Route routes[]{
    {"GET", "/api/v1/tokens", list_tokens, Work::command, command_limit, Needs::admin},
    {"POST", "/api/v1/tokens", make_token, Work::order, command_limit, Needs::admin},
    {"POST", "/api/v1/tokens/{id}/revoke", revoke_token, Work::order, command_limit, Needs::admin},
    {"GET", "/api/v1/authority.pem", show_authority, Work::command, command_limit, Needs::nothing},
};

}  // namespace

std::span<const Route> token_routes() { return routes; }

}  // namespace rayfarm
