#include "common/net/certificates.h"

#include <gtest/gtest.h>
#include <openssl/x509v3.h>

#include <array>

#include "common/net/pem.h"

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

TEST(Certificates, OfWorkersAreNotTakenForThoseOfServers) {
  const auto may_serve = [](PeerRole role) {
    const CertificatePtr made = certificate_in(certificate_of({role, "lab1"}));
    return X509_check_purpose(made.get(), X509_PURPOSE_SSL_SERVER, 0) == 1;
  };
  EXPECT_TRUE(may_serve(PeerRole::master));
  EXPECT_FALSE(may_serve(PeerRole::worker));
}

// SubjectAltName with an iPAddress of one byte: RFC 5280, 4.2.1.6 wants four or sixteen.
TEST(Certificates, NameNoHostByAnAddressOfAnotherLength) {
  const CertificatePtr certificate = certificate_in(certificate_of({PeerRole::worker, "lab1"}));
  constexpr std::array<unsigned char, 5> names{0x30, 0x03, 0x87, 0x01, 0x7f};
  const std::unique_ptr<ASN1_OCTET_STRING, FreedBy<ASN1_OCTET_STRING_free>> value(ASN1_OCTET_STRING_new());
  ASN1_OCTET_STRING_set(value.get(), names.data(), names.size());
  const std::unique_ptr<X509_EXTENSION, FreedBy<X509_EXTENSION_free>> extension(
      X509_EXTENSION_create_by_NID(nullptr, NID_subject_alt_name, 0, value.get()));
  const std::string before = pem_of(certificate.get());
  ASSERT_EQ(X509_add_ext(certificate.get(), extension.get(), -1), 1);
  ASSERT_GT(i2d_re_X509_tbs(certificate.get(), nullptr), 0);
  const std::string after = pem_of(certificate.get());
  ASSERT_GT(after.size(), before.size());
  EXPECT_EQ(facts_of(after).hosts, std::vector<std::string>());
}

TEST(Keys, AreNeverTheSame) { EXPECT_NE(new_key(), new_key()); }

}  // namespace
}  // namespace rayfarm
