// rayfarm token new, list, revoke.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/duration.h"
#include "master/cli/master_api.h"
#include "master/cli/print_json.h"
#include "master/cli/text.h"
#include "master/http/request_target.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct NewToken {
  std::string role = "worker", name, ttl;
  std::uint32_t uses = 1;
  bool link = false, json = false;
};

std::string times(std::uint32_t uses) { return uses == 1 ? "once" : std::to_string(uses) + " times"; }

/// The secret on stdout, for a file or a pipe; what to do with it on stderr.
void explain(const json& made, const NewToken& a) {
  const std::string token = made.at("token"), until = made.at("until"), authority = made.at("authority");
  if (made.at("kind") == "pairing code") {
    const std::string code = token + "@" + made.at("master").get<std::string>();
    std::printf("%s\n", code.c_str());
    std::fprintf(stderr, "On each worker's PC, %s, until %s:\n  rayfarm-worker join %s\n",
                 times(a.uses).c_str(), until.c_str(), code.c_str());
  } else if (a.link) {
    std::printf("%s\n", made.at("link").get<std::string>().c_str());
    std::fprintf(stderr, "A browser that opens it becomes %s, once, until %s.\n", a.role.c_str(),
                 until.c_str());
  } else {
    std::printf("%s\n", token.c_str());
    std::fprintf(
        stderr,
        "Keep it in a file that only you may read, and name that in RAYFARM_TOKEN_FILE; good until %s.\n",
        until.c_str());
  }
  std::fprintf(stderr, "Authority: SHA-256 %s\n", authority.c_str());
}

ExitCode make_token(const NewToken& a) {
  json wish{{"role", a.role}, {"uses", a.uses}, {"name", a.name}, {"link", a.link}};
  if (!a.ttl.empty()) wish["ttl"] = seconds_in(a.ttl);
  const json made = post_json("/api/v1/tokens", wish);
  if (a.json)
    print_json(made);
  else
    explain(made, a);
  return ExitCode::done;
}

ExitCode list_tokens(bool as_json) {
  const json answer = get_json("/api/v1/tokens");
  if (as_json) {
    print_json(answer);
    return ExitCode::done;
  }
  std::vector<std::vector<std::string>> rows{
      {"ID", "KIND", "ROLE", "STATE", "USES", "UNTIL", "FROM", "NAME"}};
  for (const json& t : answer.at("tokens"))
    rows.push_back({t.at("id"), t.at("kind"), t.at("role"), t.at("state"), t.at("uses_left").dump(),
                    t.at("until"), t.at("parent"), printable(t.at("name"))});
  std::fputs(table(rows).c_str(), stdout);
  return ExitCode::done;
}

ExitCode revoke_token(const std::string& name, bool as_json) {
  const json answer = post_json("/api/v1/tokens/" + percent_encoded(name) + "/revoke", json::object());
  if (as_json) {
    print_json(answer);
    return ExitCode::done;
  }
  for (const json& t : answer.at("revoked"))
    std::printf("revoked: %s %s %s\n", t.at("kind").get<std::string>().c_str(),
                t.at("id").get<std::string>().c_str(), printable(t.at("name")).c_str());
  return ExitCode::done;
}

void add_new(CLI::App& token, Command& chosen) {
  const auto a = std::make_shared<NewToken>();
  CLI::App* command =
      token.add_subcommand("new", "A pairing code for workers, or a token or login link for a person");
  command->add_option("--role", a->role, "worker: a code that PCs join with; or what a person may do")
      ->check(CLI::IsMember({"worker", "viewer", "artist", "admin"}))
      ->capture_default_str();
  command->add_option("--uses", a->uses, "How many PCs may join with it")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command->add_option("--ttl", a->ttl,
                      "How long it is good: 90s, 30m, 1h, 7d; 1h for a code, 10m for a link, 90d else");
  command->add_option("--name", a->name, "For the list: who it is for");
  command->add_flag("--link", a->link, "A link that logs a browser in, once");
  command->add_flag("--json", a->json, "Answer as JSON");
  command->footer(
      "Examples:\n"
      "  rayfarm token new --uses 40 --ttl 1h        a code for the forty PCs of a lab\n"
      "  rayfarm token new --role artist --name Ann > ann.token\n"
      "  rayfarm token new --role viewer --link");
  command->callback([=, &chosen] { chosen = [=] { return make_token(*a); }; });
}

}  // namespace

void add_token_command(CLI::App& app, Command& chosen) {
  CLI::App* token =
      app.add_subcommand("token", "Who may come: pairing codes, tokens, certificates of workers");
  token->require_subcommand(1);
  add_new(*token, chosen);

  const auto as_json = std::make_shared<bool>(false);
  CLI::App* list = token->add_subcommand("list", "All of them, without their secrets");
  list->add_flag("--json", *as_json, "Answer as JSON");
  list->callback([=, &chosen] { chosen = [=] { return list_tokens(*as_json); }; });

  const auto name = std::make_shared<std::string>();
  CLI::App* revoke = token->add_subcommand(
      "revoke",
      "End one at once, with what it was exchanged for: a code's workers, a link's or token's sessions");
  revoke->add_option("ID", *name, "As token list shows it, or the name of a paired worker")->required();
  revoke->add_flag("--json", *as_json, "Answer as JSON");
  revoke->callback([=, &chosen] { chosen = [=] { return revoke_token(*name, *as_json); }; });
}

}  // namespace rayfarm
