// Who may not come, at the door for workers of a farm with keys: the log says why, they themselves are told nothing.
#include <gtest/gtest.h>

#include "common/net/codec.h"
#include "common/net/run_until_end.h"
#include "common/work/engine.h"
#include "master/access/access.h"
#include "tests/support/farm_keys.h"
#include "tests/support/master_thread.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

/// What comes first to who says this over TLS; nothing when the master ends it.
std::string answer_to(const ToMaster& said, const Address& master, const TlsContext& shown) {
  asio::io_context io;
  std::string answer;
  const auto converse = [&]() -> asio::awaitable<void> {
    auto dialling = dial_encrypted(master, shown, 60s);
    Channel channel = co_await std::move(dialling);
    const Bytes bytes = encode(said);
    const std::vector<asio::const_buffer> message{asio::buffer(bytes)};
    co_await channel.write(message);
    std::array<char, 4096> room;
    const std::size_t size = co_await channel.read_some(asio::buffer(room));
    answer.assign(room.data(), size);
  };
  try {
    run_until_end(io, converse());
  } catch (const asio::system_error&) {  // ended
  }
  return answer;
}

struct Strangers : testing::Test {
  ScratchFolder folder, elsewhere;
  const WallTime now = std::chrono::system_clock::now();
  Access access{folder.path(), {"127.0.0.1"}, now};
  Access other{elsewhere.path(), {"127.0.0.1"}, now};
  MasterThread master{DoorLimits{{60s, 60s, 60s}, {1ms, 10ms}},
                      {"127.0.0.1", 0},
                      {Exposure::closed, TlsContext(access.identity(), access.authority(), PeerRole::worker)},
                      &access};
  const std::string request = certificate_request(new_key());

  Join join_with(const Token& code) const {
    return {{}, "0.1.0", code.secret, "lab7", {request.begin(), request.end()}};
  }
  static Identity paired(Access& farm, const std::string& name, WallTime when) {
    const std::string key = new_key(), asked = certificate_request(key);
    const Token code = farm.issue({}, when).token;
    return {key, farm.pair({{}, "0.1.0", code.secret, name, {asked.begin(), asked.end()}}, "10.0.0.7", when)};
  }
  std::string answer_to_code(const Token& code) const {
    return answer_to(join_with(code), master.address(), TlsContext::of_stranger());
  }
  std::string answer_to_worker(const Identity& shown) const {
    const Hello hello{{protocol_version, oldest_protocol_version, {}},
                      "0.1.0",
                      "lab7",
                      "a test's CPU",
                      1,
                      engine_fingerprint()};
    return answer_to(hello, master.address(), TlsContext(shown, access.authority(), PeerRole::master));
  }
  void wait_for_log(const std::string& words) {
    master.wait_until([&](Farm&) {
      return std::ranges::any_of(
          master.door().log(0), [&](const auto& e) { return e.event.text.find(words) != std::string::npos; });
    });
  }
};

TEST_F(Strangers, WithABadCodeGetNothingAndTheLogSaysWhy) {
  const Issued used = access.issue({}, now), revoked = access.issue({}, now),
               expired = access.issue({.lifetime = 1s}, now - 2s),
               person = access.issue({.kind = CredentialKind::token, .role = Role::admin}, now);
  EXPECT_NE(answer_to_code(used.token).size(), 0u) << "the first time it is good";
  access.revoke(revoked.credential.id);
  const std::vector<std::pair<std::string, Token>> bad{
      {"was used already", used.token},
      {"was revoked", revoked.token},
      {"has expired", expired.token},
      {"there is no such pairing code", new_token(access.fingerprint())},
      {"there is no such pairing code", person.token},
      {"there is no such pairing code", new_token(other.fingerprint())}};
  for (const auto& [why, code] : bad) {
    EXPECT_EQ(answer_to_code(code), "") << why;
    wait_for_log(why);
  }
}

TEST_F(Strangers, WithABadCertificateGetNothingAndTheLogSaysWhy) {
  const Identity revoked = paired(access, "revoked", now),
                 expired = paired(access, "old", now - std::chrono::years(11)),
                 foreign = paired(other, "spy", now);
  access.revoke("revoked");
  const std::vector<std::pair<std::string, Identity>> bad{{"was revoked", revoked},
                                                          {"it has expired", expired},
                                                          {"it is of another farm", foreign},
                                                          {"it is a master's", access.identity()}};
  for (const auto& [why, shown] : bad) {
    EXPECT_EQ(answer_to_worker(shown), "") << why;
    wait_for_log(why);
  }
  EXPECT_NE(answer_to_worker(paired(access, "lab7", now)), "") << "a good one is welcome";
}

}  // namespace
}  // namespace rayfarm
