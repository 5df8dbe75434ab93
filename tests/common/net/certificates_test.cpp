#include "common/net/certificates.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

const WallTime now = std::chrono::system_clock::now();
const Identity& authority() {
  static const Identity made = new_authority(now);
  return made;
}

std::string certificate_of(const Owner& owner) {
  return issue(authority(), certificate_request(new_key()), owner, {now, now + 1h});
}

TEST(Certificates, SayWhoseTheyAreAndUntilWhen) {
  const std::string made = certificate_of(
      {PeerRole::master, "Müllers Büro", {"lab1", "192.168.1.11", "::1", "lab1.local", "no, IP:6.6.6.6"}});
  const CertificateFacts facts = facts_of(made);
  EXPECT_EQ(facts.role, PeerRole::master);
  EXPECT_EQ(facts.name, "Müllers Büro");
  EXPECT_EQ(facts.hosts, (std::vector<std::string>{"192.168.1.11", "::1", "lab1", "lab1.local"}));
  EXPECT_EQ(facts.until, std::chrono::floor<std::chrono::seconds>(now + 1h));
  EXPECT_EQ(facts.id, fingerprint_of(made));
  EXPECT_EQ(facts.id.size(), 64u);
  EXPECT_EQ(facts_of(certificate_of({PeerRole::worker, "lab7"})).role, PeerRole::worker);
}

TEST(Certificates, AreSignedByTheirAuthorityAloneForTheKeyThatAsked) {
  const std::string key = new_key(), request = certificate_request(key);
  const std::string made = issue(authority(), request, {PeerRole::worker, "lab7"}, {now, now + 1h});
  EXPECT_TRUE(is_signed_by(made, authority().certificate));
  EXPECT_FALSE(is_signed_by(made, new_authority(now).certificate));
  EXPECT_TRUE(is_of_key(made, key));
  EXPECT_FALSE(is_of_key(made, new_key()));
  EXPECT_TRUE(is_of_key(authority().certificate, authority().key));
}

TEST(Certificates, AreNotGivenForARequestThatProvesNothing) {
  std::string request = certificate_request(new_key());
  request[request.size() / 2] ^= 1;  // in the middle of its base64
  for (const std::string& bad : {request, std::string(), authority().certificate, std::string(5000, 'A')})
    EXPECT_THROW(issue(authority(), bad, {PeerRole::worker, "lab7"}, {now, now + 1h}), CertificateError);
}

TEST(Certificates, AreNotGivenToNamesThatTheyCannotHold) {
  EXPECT_NO_THROW(certificate_of({PeerRole::worker, std::string(max_owner_name, 'x')}));
  EXPECT_THROW(certificate_of({PeerRole::worker, std::string(max_owner_name + 1, 'x')}), CertificateError);
}

TEST(Certificates, OfGarbageAreAnError) {
  EXPECT_THROW(facts_of("-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n"), CertificateError);
  EXPECT_THROW(facts_of(""), CertificateError);
  EXPECT_THROW(certificate_request(authority().certificate), CertificateError);
}

TEST(Keys, AreNeverTheSame) { EXPECT_NE(new_key(), new_key()); }

}  // namespace
}  // namespace rayfarm
