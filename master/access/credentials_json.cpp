#include "master/access/credentials_json.h"

#include <array>
#include <nlohmann/json.hpp>

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr int format = 1;

constexpr std::array kinds{CredentialKind::pairing_code, CredentialKind::certificate, CredentialKind::token,
                           CredentialKind::login_link, CredentialKind::session};

std::int64_t seconds(WallTime time) {
  return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
}
WallTime time_of(const json& value) {
  constexpr auto most = std::chrono::floor<std::chrono::seconds>(WallTime::duration::max()).count();
  if (!value.is_number_integer() || value > most || value < -most)
    throw std::runtime_error("a time must be a number of seconds, is " + value.dump());
  return WallTime(std::chrono::seconds(value.get<std::int64_t>()));
}

std::uint32_t count_of(const json& value) {
  if (!value.is_number_unsigned() || value > UINT32_MAX)
    throw std::runtime_error("a number of uses must be a whole number, is " + value.dump());
  return value.get<std::uint32_t>();
}

json to_json(const Credential& c) {
  return {{"id", c.id},
          {"kind", name_of(c.kind)},
          {"role", name_of(c.role)},
          {"name", c.name},
          {"proof", c.proof},
          {"parent", c.parent},
          {"made", seconds(c.made)},
          {"until", seconds(c.until)},
          {"uses_left", c.uses_left},
          {"revoked", c.is_revoked}};
}

CredentialKind kind_named(const std::string& name) {
  for (const CredentialKind kind : kinds)
    if (name_of(kind) == name) return kind;
  throw std::runtime_error("there is no kind \"" + name + "\"");
}

Credential credential_in(const json& value) {
  Credential c;
  const std::optional<Role> role = role_named(value.at("role").get<std::string>());
  if (!role) throw std::runtime_error("there is no role " + value.at("role").dump());
  c.id = value.at("id"), c.kind = kind_named(value.at("kind")), c.role = *role;
  c.name = value.at("name"), c.proof = value.at("proof"), c.parent = value.at("parent");
  c.made = time_of(value.at("made")), c.until = time_of(value.at("until"));
  c.uses_left = count_of(value.at("uses_left")), c.is_revoked = value.at("revoked");
  return c;
}

}  // namespace

std::string json_of(const Credentials& credentials) {
  json all = json::array();
  for (const Credential& c : credentials.all()) all.push_back(to_json(c));
  return json{{"format", format}, {"credentials", std::move(all)}}.dump(1) + "\n";
}

Credentials credentials_in(const std::string& text) try {
  const json value = json::parse(text);
  if (value.at("format") != format) throw std::runtime_error("it was written by another version of rayfarm");
  std::vector<Credential> all;
  for (const json& entry : value.at("credentials")) all.push_back(credential_in(entry));
  return Credentials(std::move(all));
} catch (const json::exception& error) {
  throw std::runtime_error(error.what());
}

}  // namespace rayfarm
