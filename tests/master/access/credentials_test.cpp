#include "master/access/credentials.h"

#include <gtest/gtest.h>

#include "master/access/attempts.h"
#include "master/access/credentials_json.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

const WallTime noon = WallTime(std::chrono::seconds(1'800'000'000));

Credential code(const std::string& proof, std::uint32_t uses) {
  return {.kind = CredentialKind::pairing_code,
          .role = Role::worker,
          .proof = proof,
          .made = noon,
          .until = noon + 1h,
          .uses_left = uses};
}
Credential certificate(const std::string& proof, const std::string& name, const std::string& parent) {
  return {.kind = CredentialKind::certificate,
          .role = Role::worker,
          .name = name,
          .proof = proof,
          .parent = parent,
          .made = noon,
          .until = noon + 1000h};
}

template <class Call>
std::string refusal_of(Call call) {
  try {
    call();
  } catch (const AccessRefused& refused) {
    return refused.what();
  }
  return "";
}

TEST(Credentials, OfACodeEndWithItsUsesAndItsTime) {
  Credentials all;
  const std::string id = all.add(code("a", 2)).id;
  const auto use = [&](WallTime when) {
    return refusal_of([&] { all.use(CredentialKind::pairing_code, "a", when); });
  };
  EXPECT_EQ(use(noon), "");
  EXPECT_EQ(use(noon + 1h), "pairing code " + id + " has expired");
  EXPECT_EQ(use(noon + 59min), "");
  EXPECT_EQ(use(noon + 59min), "pairing code " + id + " was used already");
  EXPECT_THROW(all.use(CredentialKind::pairing_code, "b", noon), UnknownSecret);
  EXPECT_THROW(all.check(CredentialKind::token, "a", noon), UnknownSecret) << "each kind has its door";
}

TEST(Credentials, ThatAreRevokedEndWithAllThatCameOfThem) {
  Credentials all;
  const std::string lab = all.add(code("a", 40)).id, other = all.add(code("b", 1)).id;
  all.add(certificate("1", "lab1", lab));
  all.add(certificate("2", "lab2", lab));
  all.add(certificate("3", "lab3", other));
  const auto check = [&](const char* proof) {
    return refusal_of([&] { all.check(CredentialKind::certificate, proof, noon); });
  };
  EXPECT_EQ(all.revoke("lab2").size(), 1u);
  EXPECT_EQ(check("1"), "");
  EXPECT_NE(check("2").find("was revoked"), std::string::npos);
  EXPECT_EQ(all.revoke(lab).size(), 2u) << "the code and lab1";
  EXPECT_NE(check("1").find("was revoked"), std::string::npos);
  EXPECT_NE(refusal_of([&] { all.use(CredentialKind::pairing_code, "a", noon); }), "");
  EXPECT_EQ(check("3"), "");
  EXPECT_TRUE(all.revoke("nobody").empty());
  EXPECT_TRUE(all.revoke("").empty());
}

TEST(Credentials, ThatAreForgottenCanStillBeRevokedWithWhatCameOfThem) {
  Credentials all;
  const std::string lab = all.add(code("a", 40)).id;
  all.add(certificate("1", "lab1", lab));
  all.forget_ended(noon + std::chrono::days(40));
  ASSERT_EQ(all.all().size(), 1u);
  ASSERT_EQ(all.revoke(lab).size(), 1u);
  EXPECT_NE(refusal_of([&] { all.check(CredentialKind::certificate, "1", noon); }), "");
}

TEST(Credentials, KeepTheNamesOfOthers) {
  Credentials all;
  all.add(certificate("1", "lab1", "x"));
  const std::string again = all.add(certificate("2", "lab1", "x")).id;
  all.add(certificate("3", "lab3", "x"));
  const auto is_taken = [&](const std::string& name, const std::string& of, WallTime when = noon) {
    CertificateFacts facts;
    facts.name = of;
    return all.is_name_of_another(name, facts, when);
  };
  EXPECT_TRUE(is_taken("lab1", "lab3"));
  EXPECT_FALSE(is_taken("lab1", "lab1")) << "it was paired again";
  EXPECT_FALSE(is_taken("lab2", "lab3")) << "nobody was";
  EXPECT_FALSE(is_taken("lab1", "lab3", noon + 1000h)) << "they have expired";
  all.revoke(again);
  EXPECT_TRUE(is_taken("lab1", "lab3"));
  all.revoke("lab1");
  EXPECT_FALSE(is_taken("lab1", "lab3"));
}

TEST(Credentials, AreReadAsTheyWereWritten) {
  Credentials all;
  const std::string lab = all.add(code("a", 3)).id;
  all.add(certificate("1", "Müllers \"PC\"", lab));
  all.revoke("Müllers \"PC\"");
  const Credentials again = credentials_in(json_of(all));
  EXPECT_EQ(json_of(again), json_of(all));
  ASSERT_EQ(again.all().size(), 2u);
  EXPECT_EQ(again.all()[0].uses_left, 3u);
  EXPECT_EQ(again.all()[0].until, noon + 1h);
  EXPECT_EQ(again.all()[1].name, "Müllers \"PC\"");
  EXPECT_TRUE(again.all()[1].is_revoked);
  for (const char* bad : {"", "{}", "[]", R"({"format": 2, "credentials": []})",
                          R"({"format": 1, "credentials": [{"id": 1}]})"})
    EXPECT_ANY_THROW(credentials_in(bad)) << bad;
}

TEST(Credentials, AreForgottenAMonthAfterTheirEnd) {
  Credentials all;
  all.add(code("a", 1));
  all.forget_ended(noon + 1h + std::chrono::days(29));
  EXPECT_EQ(all.all().size(), 1u);
  all.forget_ended(noon + 1h + std::chrono::days(30));
  EXPECT_TRUE(all.all().empty());
}

TEST(Attempts, AreClosedForAMinuteToWhoWasWrongTooOften) {
  Attempts attempts;
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(attempts.are_open_to("10.0.0.7", noon));
    attempts.count_wrong("10.0.0.7", noon);
  }
  EXPECT_FALSE(attempts.are_open_to("10.0.0.7", noon + 59s));
  EXPECT_TRUE(attempts.are_open_to("10.0.0.8", noon));
  EXPECT_TRUE(attempts.are_open_to("10.0.0.7", noon + 1min));
}

}  // namespace
}  // namespace rayfarm
