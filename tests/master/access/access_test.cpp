#include "master/access/access.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <future>
#include <thread>

#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

const std::vector<std::string> hosts{"lab1", "127.0.0.1"};

Join request_with(const Token& code, const std::string& key, const std::string& name = "lab7") {
  const std::string request = certificate_request(key);
  return {{}, "0.1.0", code.secret, name, {request.begin(), request.end()}};
}

struct TheAccess : testing::Test {
  ScratchFolder folder;
  const WallTime now = std::chrono::system_clock::now();
  Access access{folder.path(), hosts, now};

  std::string pair(const Token& code, const std::string& from = "10.0.0.7") {
    return access.pair(request_with(code, new_key()), from, now);
  }
};

TEST_F(TheAccess, KeepsItsKeysAndWhoItLetInFromStartToStart) {
  const std::string certificate = pair(access.issue({}, now).token);
  const Access again(folder.path(), hosts, now + 1h);
  EXPECT_EQ(again.authority(), access.authority());
  EXPECT_EQ(again.identity(), access.identity());
  EXPECT_NO_THROW(again.check_worker(facts_of(certificate), now));
}

TEST_F(TheAccess, MakesTheMastersCertificateAnewWhenItIsOldOrThePcHasAnotherName) {
  const Access renamed(folder.path(), {"lab2"}, now);
  EXPECT_NE(renamed.identity(), access.identity());
  EXPECT_EQ(renamed.authority(), access.authority());
  const Access later(folder.path(), {"lab2"}, now + std::chrono::days(500));
  EXPECT_NE(later.identity(), renamed.identity());
  EXPECT_TRUE(is_signed_by(later.identity().certificate, access.authority()));
}

TEST_F(TheAccess, RecoversFromAClockThatWasAhead) {
  const Access ahead(folder.path(), hosts, now + std::chrono::days(500));
  EXPECT_GT(facts_of(ahead.identity().certificate).from, now);
  const Access again(folder.path(), hosts, now);
  EXPECT_LE(facts_of(again.identity().certificate).from, now);
  EXPECT_GT(facts_of(again.identity().certificate).until, now);
  try {
    Access(folder.path(), hosts, now - std::chrono::days(300));
    ADD_FAILURE() << "its authority is not valid yet";
  } catch (const CertificateError& error) {
    EXPECT_NE(std::string(error.what()).find("set the clock"), std::string::npos) << error.what();
  }
}

TEST_F(TheAccess, WritesFilesThatOnlyTheirOwnerMayRead) {
  access.issue({}, now);
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    struct stat facts {};
    ASSERT_EQ(::stat(file.path().c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777, 0600u) << file.path();
    ++files;
  }
  EXPECT_EQ(files, 4) << "authority.pem, master.pem, credentials.json, admin.token";
  std::filesystem::permissions(folder / "authority.pem", std::filesystem::perms(0640));
  EXPECT_THROW(Access(folder.path(), hosts, now), std::runtime_error);
}

TEST_F(TheAccess, SaysWhichFileIsBroken) {
  for (const char* name : {"authority.pem", "master.pem", "credentials.json"}) {
    const std::string kept = content_of(folder / name);
    put_content(folder / name, kept.substr(0, kept.size() / 2));
    try {
      Access(folder.path(), hosts, now);
      ADD_FAILURE() << name;
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
    put_content(folder / name, kept);
  }
}

TEST_F(TheAccess, GivesAWorkerTheCertificateThatItsCodeIsGoodFor) {
  const Token code = access.issue({.uses = 2}, now).token;
  EXPECT_TRUE(access.fingerprint().starts_with(code.farm));
  const std::string key = new_key();
  const std::string certificate = access.pair(request_with(code, key, "lab7"), "10.0.0.7", now);
  EXPECT_TRUE(is_of_key(certificate, key));
  EXPECT_TRUE(is_signed_by(certificate, access.authority()));
  EXPECT_EQ(facts_of(certificate).role, PeerRole::worker);
  EXPECT_EQ(facts_of(certificate).name, "lab7");
  EXPECT_NO_THROW(pair(code));
  EXPECT_THROW(pair(code), AccessRefused);
}

TEST_F(TheAccess, GivesAsManyCertificatesAsItsCodeHasUsesHoweverManyAskAtOnce) {
  const Token code = access.issue({.uses = 5}, now).token;
  std::atomic<int> paired = 0, refused = 0;
  {
    std::vector<std::jthread> pcs;
    for (int i = 0; i < 12; ++i)
      pcs.emplace_back([&, i] {
        try {
          pair(code, "10.0.0." + std::to_string(i)), ++paired;
        } catch (const AccessRefused&) {
          ++refused;
        }
      });
  }
  EXPECT_EQ(paired, 5);
  EXPECT_EQ(refused, 7);
}

TEST_F(TheAccess, LosesNoUseOfACodeToARequestThatIsNone) {
  const Token code = access.issue({}, now).token;
  EXPECT_THROW(access.pair({{}, "0.1.0", code.secret, "lab7", {1, 2, 3}}, "10.0.0.7", now), AccessRefused);
  EXPECT_THROW(access.pair(request_with(code, new_key(), std::string(100, 'x')), "10.0.0.7", now),
               AccessRefused);
  EXPECT_NO_THROW(pair(code));
}

TEST_F(TheAccess, RefusesWrongExpiredAndRevokedCodes) {
  EXPECT_THROW(pair(new_token(access.fingerprint())), UnknownSecret);
  const Issued expired = access.issue({.lifetime = 1s}, now - 2s), revoked = access.issue({}, now);
  EXPECT_THROW(pair(expired.token), AccessRefused);
  EXPECT_EQ(access.revoke(revoked.credential.id).size(), 1u);
  EXPECT_THROW(pair(revoked.token), AccessRefused);
  const Issued token = access.issue({.kind = CredentialKind::token, .role = Role::admin}, now);
  EXPECT_THROW(pair(token.token), UnknownSecret) << "what opens one door does not open another";
}

TEST_F(TheAccess, LooksAtNothingFromWhereItWasWrongTooOften) {
  const Token code = access.issue({}, now).token;
  for (int i = 0; i < 10; ++i) EXPECT_THROW(pair(new_token(access.fingerprint())), UnknownSecret);
  EXPECT_THROW(pair(code), AccessRefused);
  EXPECT_NO_THROW(pair(code, "10.0.0.8"));
}

TEST_F(TheAccess, ShutsNobodyOutForWhatOthersAtTheSameAddressGotWrong) {
  const std::string token =
      text_of(access.issue({.kind = CredentialKind::token, .role = Role::viewer}, now).token);
  const std::string proxy = "10.0.0.1";
  for (int i = 0; i < 10; ++i)
    EXPECT_THROW(access.check_person(text_of(new_token(access.fingerprint())), proxy, now), UnknownSecret);
  try {
    access.check_person(text_of(new_token(access.fingerprint())), proxy, now);
    ADD_FAILURE();
  } catch (const AccessRefused& refused) {
    EXPECT_STREQ(refused.what(), "it was wrong too often just now")
        << "the log gets one line, not one for each";
  }
  EXPECT_EQ(access.check_person(token, proxy, now).role, Role::viewer);
}

TEST_F(TheAccess, KnowsNoCertificateThatItDoesNotRemember) {
  const std::string certificate = pair(access.issue({}, now).token);
  EXPECT_NO_THROW(access.check_worker(facts_of(certificate), now));
  EXPECT_THROW(access.check_worker(facts_of(certificate), now + std::chrono::years(11)), AccessRefused);
  EXPECT_EQ(access.revoke("lab7").size(), 1u);
  EXPECT_THROW(access.check_worker(facts_of(certificate), now), AccessRefused);
  EXPECT_THROW(access.check_worker(facts_of(access.identity().certificate), now), AccessRefused);
}

TEST_F(TheAccess, KnowsPeopleByTheirTokensAndBrowsersByTheSessionsOfTheirLinks) {
  const Issued token =
      access.issue({.kind = CredentialKind::token, .role = Role::artist, .name = "Ann"}, now);
  EXPECT_EQ(access.check_person(text_of(token.token), "10.0.0.7", now).role, Role::artist);
  const Issued link = access.issue({.kind = CredentialKind::login_link, .role = Role::viewer}, now);
  EXPECT_THROW(access.check_person(text_of(link.token), "10.0.0.7", now), AccessRefused)
      << "a link is no token";
  const Issued session = access.log_in(text_of(link.token), "10.0.0.7", now);
  EXPECT_EQ(access.check_person(text_of(session.token), "10.0.0.7", now).role, Role::viewer);
  EXPECT_THROW(access.log_in(text_of(link.token), "10.0.0.7", now), AccessRefused) << "once";
  EXPECT_EQ(access.revoke(link.credential.id).size(), 2u) << "the link and its session";
  EXPECT_THROW(access.check_person(text_of(session.token), "10.0.0.7", now), AccessRefused);
  EXPECT_THROW(access.check_person("hello", "10.0.0.7", now), UnknownSecret);
  const std::string elsewhere = text_of(new_token(std::string(64, 'a')));
  for (int i = 0; i < 20; ++i)
    EXPECT_THROW(access.check_person(elsewhere, "10.0.0.7", now), AccessRefused) << "another farm's";
  const Issued another = access.issue({.kind = CredentialKind::login_link, .role = Role::viewer}, now);
  EXPECT_NO_THROW(access.log_in(text_of(another.token), "10.0.0.7", now)) << "none of these was a guess";
}

TEST_F(TheAccess, GivesABrowserASessionForATokenUntilItLogsOut) {
  const Issued token = access.issue(
      {.kind = CredentialKind::token, .role = Role::artist, .name = "Ann", .lifetime = std::chrono::hours(2)},
      now);
  const std::string shown = text_of(token.token);
  const Issued session = access.log_in_with_token(shown, "10.0.0.7", now);
  const std::string cookie = text_of(session.token);
  EXPECT_EQ(session.credential.until, token.credential.until) << "no longer than the token";
  EXPECT_EQ(access.session(cookie, now)->name, "Ann");
  EXPECT_EQ(access.session(shown, now), std::nullopt) << "a token is no session";
  EXPECT_EQ(access.session("", now), std::nullopt);
  EXPECT_THROW(access.log_in_with_token(cookie, "10.0.0.7", now), AccessRefused) << "nor the reverse";

  access.log_out(shown, now);
  EXPECT_EQ(access.check_person(shown, "10.0.0.7", now).role, Role::artist) << "who logs out keeps the token";
  access.log_out(cookie, now);
  EXPECT_EQ(access.session(cookie, now), std::nullopt);
  EXPECT_THROW(access.check_person(cookie, "10.0.0.7", now), AccessRefused);
  access.log_out(cookie, now), access.log_out("hello", now);
}

TEST_F(TheAccess, KeepsTwentySessionsOfOneTokenTheNewest) {
  const Issued token = access.issue({.kind = CredentialKind::token, .role = Role::viewer}, now);
  const std::size_t before = access.list().size();
  std::vector<std::string> cookies;
  for (int i = 0; i < 50; ++i)
    cookies.push_back(text_of(access.log_in_with_token(text_of(token.token), "10.0.0.7", now).token));
  EXPECT_EQ(access.list().size(), before + 20);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(access.session(cookies[i], now).has_value(), i >= 30) << i;
}

TEST_F(TheAccess, MayBeAskedByManyAtOnce) {
  const auto come_and_go = [&] {
    for (int i = 0; i < 5; ++i) {
      const Issued made = access.issue({.kind = CredentialKind::token, .role = Role::viewer}, now);
      EXPECT_EQ(access.check_person(text_of(made.token), "10.0.0.7", now).role, Role::viewer);
      EXPECT_EQ(access.revoke(made.credential.id).size(), 1u);
      EXPECT_THROW(access.check_person(text_of(made.token), "10.0.0.7", now), AccessRefused);
    }
  };
  std::vector<std::future<void>> people;
  for (int i = 0; i < 4; ++i) people.push_back(std::async(std::launch::async, come_and_go));
  for (auto& person : people) person.get();
  EXPECT_EQ(access.list().size(), 1u + 4 * 5) << "and admin.token";
}

TEST_F(TheAccess, KeepsNoSecretOnTheDisk) {
  const Issued issued = access.issue({}, now);
  const std::string kept = content_of(folder / "credentials.json");
  EXPECT_EQ(kept.find(issued.token.secret), std::string::npos);
  EXPECT_NE(kept.find(hash_of_secret(issued.token.secret)), std::string::npos);
}

}  // namespace
}  // namespace rayfarm
