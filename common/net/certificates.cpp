#include "common/net/certificates.h"

#include <arpa/inet.h>
#include <openssl/ec.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <array>

#include "common/net/codec.h"
#include "common/net/openssl_ptr.h"
#include "common/net/pem.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr auto authority_lifetime = std::chrono::years(20);
constexpr auto clock_tolerance = 24h;  // clocks of a lab's PCs differ
constexpr long version_3 = 2;          // as X.509 counts

using ExtensionPtr = std::unique_ptr<X509_EXTENSION, FreedBy<X509_EXTENSION_free>>;
using NamesPtr = std::unique_ptr<GENERAL_NAMES, FreedBy<GENERAL_NAMES_free>>;

// Making. --------------------------------------------------------------------------------------------------

KeyPtr make_key() {
  KeyPtr key(EVP_EC_gen("P-256"));
  expect_done(key != nullptr, "no key could be made");
  return key;
}

void set_number(X509* certificate) {
  std::array<unsigned char, 16> bytes;
  expect_done(RAND_bytes(bytes.data(), bytes.size()) == 1, "there are no random numbers");
  bytes[0] &= 0x7f;  // it must not be negative
  const std::unique_ptr<BIGNUM, FreedBy<BN_free>> number(BN_bin2bn(bytes.data(), bytes.size(), nullptr));
  expect_done(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr,
              "a number could not be set");
}

void set_validity(X509* certificate, const Validity& validity) {
  expect_done(
      ASN1_TIME_set(X509_getm_notBefore(certificate), std::chrono::system_clock::to_time_t(validity.from)) &&
          ASN1_TIME_set(X509_getm_notAfter(certificate),
                        std::chrono::system_clock::to_time_t(validity.until)),
      "a time could not be set");
}

void add_to_name(X509_NAME* name, const char* field, std::string_view value) {
  expect_done(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8,
                                         reinterpret_cast<const unsigned char*>(value.data()),
                                         static_cast<int>(value.size()), -1, 0) == 1,
              "the name cannot stand in a certificate");
}

void add_extension(X509* certificate, X509* issuer, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const ExtensionPtr extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  expect_done(extension && X509_add_ext(certificate, extension.get(), -1) == 1,
              "a certificate could not be made");
}

bool is_address(const std::string& host) {
  unsigned char bytes[sizeof(in6_addr)];
  return inet_pton(AF_INET, host.c_str(), bytes) == 1 || inet_pton(AF_INET6, host.c_str(), bytes) == 1;
}

std::string alternative_names(const std::vector<std::string>& hosts) {
  std::string names;
  for (const std::string& host : hosts) {
    // What could be taken for the syntax of the list is no host.
    if (host.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.:-_") !=
        std::string::npos)
      continue;
    names += (names.empty() ? "" : ",") + std::string(is_address(host) ? "IP:" : "DNS:") + host;
  }
  return names;
}

CertificatePtr begin_certificate(EVP_PKEY* key, const Validity& validity) {
  CertificatePtr certificate(X509_new());
  expect_done(certificate && X509_set_version(certificate.get(), version_3) == 1 &&
                  X509_set_pubkey(certificate.get(), key) == 1,
              "a certificate could not be made");
  set_number(certificate.get());
  set_validity(certificate.get(), validity);
  add_to_name(X509_get_subject_name(certificate.get()), "O", "rayfarm");
  return certificate;
}

void sign(X509* certificate, X509* issuer, EVP_PKEY* key) {
  expect_done(X509_set_issuer_name(certificate, X509_get_subject_name(issuer)) == 1 &&
                  X509_sign(certificate, key, EVP_sha256()) > 0,
              "a certificate could not be signed");
}

/// The key that the request is for, which has signed it.
KeyPtr key_of_request(const std::string& request) {
  const RequestPtr parsed = request_in(request);
  KeyPtr key(X509_REQ_get_pubkey(parsed.get()));
  expect_done(key && X509_REQ_verify(parsed.get(), key.get()) == 1,
              "the request does not prove that its sender has the key");
  return key;
}

// Reading. -------------------------------------------------------------------------------------------------

std::string text_of(const ASN1_STRING* text) {
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<std::size_t>(ASN1_STRING_length(text))};
}

std::string field_of(const X509* certificate, int field) {
  const X509_NAME* name = X509_get_subject_name(certificate);
  const int place = X509_NAME_get_index_by_NID(name, field, -1);
  return place < 0 ? "" : text_of(X509_NAME_ENTRY_get_data(X509_NAME_get_entry(name, place)));
}

/// Empty when so many bytes are no address.
std::string address_text(const ASN1_OCTET_STRING* bytes) {
  const int length = ASN1_STRING_length(bytes);
  if (length != sizeof(in_addr) && length != sizeof(in6_addr)) return "";
  std::array<char, INET6_ADDRSTRLEN> text{};
  inet_ntop(length == sizeof(in_addr) ? AF_INET : AF_INET6, ASN1_STRING_get0_data(bytes), text.data(),
            text.size());
  return text.data();
}

std::vector<std::string> hosts_of(const X509* certificate) {
  std::vector<std::string> hosts;
  const NamesPtr names(
      static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; names && i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(names.get(), i);
    if (name->type == GEN_DNS) hosts.push_back(text_of(name->d.dNSName));
    if (name->type == GEN_IPADD)
      if (std::string address = address_text(name->d.iPAddress); !address.empty())
        hosts.push_back(std::move(address));
  }
  std::ranges::sort(hosts);
  return hosts;
}

WallTime time_of(const ASN1_TIME* written) {
  std::tm time{};
  expect_done(ASN1_TIME_to_tm(written, &time) == 1, "the certificate's beginning or end is no time");
  return std::chrono::system_clock::from_time_t(timegm(&time));
}

std::string id_of(const X509* certificate) {
  unsigned char* der = nullptr;
  const int size = i2d_X509(certificate, &der);
  expect_done(size > 0, "a certificate could not be written");
  const std::unique_ptr<unsigned char, FreedBy<[](void* p) { OPENSSL_free(p); }>> owner(der);
  return sha256_hex({der, static_cast<std::size_t>(size)});
}

}  // namespace

std::string_view name_of(PeerRole role) { return role == PeerRole::master ? "master" : "worker"; }

std::vector<std::string> pem_blocks(std::string_view text) {
  std::vector<std::string> blocks;
  for (std::size_t at = text.find("-----BEGIN "); at != text.npos; at = text.find("-----BEGIN ", at)) {
    const std::size_t end = text.find("-----END ", at), line = text.find('\n', end);
    if (end == text.npos) break;
    blocks.push_back(std::string(text.substr(at, line - at)) + "\n");
    at = end;
  }
  return blocks;
}

std::string new_key() { return pem_of(make_key().get()); }

std::string certificate_request(const std::string& key) {
  const KeyPtr own = key_in(key);
  const RequestPtr request(X509_REQ_new());
  expect_done(request && X509_REQ_set_pubkey(request.get(), own.get()) == 1 &&
                  X509_REQ_sign(request.get(), own.get(), EVP_sha256()) > 0,
              "a request could not be made");
  return pem_of(request.get());
}

Identity new_authority(WallTime now) {
  const KeyPtr key = make_key();
  const CertificatePtr own = begin_certificate(key.get(), {now - clock_tolerance, now + authority_lifetime});
  add_to_name(X509_get_subject_name(own.get()), "CN", "rayfarm authority");
  add_extension(own.get(), own.get(), NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  add_extension(own.get(), own.get(), NID_key_usage, "critical,keyCertSign,cRLSign");
  add_extension(own.get(), own.get(), NID_subject_key_identifier, "hash");
  sign(own.get(), own.get(), key.get());
  return {pem_of(key.get()), pem_of(own.get())};
}

std::string issue(const Identity& authority, const std::string& request, const Owner& owner,
                  Validity validity) {
  const KeyPtr signing_key = key_in(authority.key);
  const CertificatePtr issuer = certificate_in(authority.certificate);
  const CertificatePtr issued =
      begin_certificate(key_of_request(request).get(), {validity.from - clock_tolerance, validity.until});
  add_to_name(X509_get_subject_name(issued.get()), "OU", name_of(owner.role));
  add_to_name(X509_get_subject_name(issued.get()), "CN", owner.name);
  add_extension(issued.get(), issuer.get(), NID_basic_constraints, "critical,CA:FALSE");
  add_extension(issued.get(), issuer.get(), NID_key_usage, "critical,digitalSignature");
  // Either may dial, which our own programs know; others must not take a worker for the master's web server.
  add_extension(issued.get(), issuer.get(), NID_ext_key_usage,
                owner.role == PeerRole::master ? "serverAuth,clientAuth" : "clientAuth");
  add_extension(issued.get(), issuer.get(), NID_subject_key_identifier, "hash");
  add_extension(issued.get(), issuer.get(), NID_authority_key_identifier, "keyid");
  if (const std::string names = alternative_names(owner.hosts); !names.empty())
    add_extension(issued.get(), issuer.get(), NID_subject_alt_name, names);
  sign(issued.get(), issuer.get(), signing_key.get());
  return pem_of(issued.get());
}

CertificateFacts facts_of(const std::string& certificate) {
  const CertificatePtr parsed = certificate_in(certificate);
  const bool is_master = field_of(parsed.get(), NID_organizationalUnitName) == name_of(PeerRole::master);
  return {id_of(parsed.get()),
          is_master ? PeerRole::master : PeerRole::worker,
          field_of(parsed.get(), NID_commonName),
          hosts_of(parsed.get()),
          time_of(X509_get0_notBefore(parsed.get())),
          time_of(X509_get0_notAfter(parsed.get()))};
}

std::string fingerprint_of(const std::string& certificate) {
  return id_of(certificate_in(certificate).get());
}

bool is_signed_by(const std::string& certificate, const std::string& authority) {
  const CertificatePtr issuer = certificate_in(authority);
  const bool is_so = X509_verify(certificate_in(certificate).get(), X509_get0_pubkey(issuer.get())) == 1;
  ERR_clear_error();
  return is_so;
}

bool is_of_key(const std::string& certificate, const std::string& key) {
  const bool is_so = X509_check_private_key(certificate_in(certificate).get(), key_in(key).get()) == 1;
  ERR_clear_error();
  return is_so;
}

}  // namespace rayfarm
