#include "common/net/pem.h"

#include <openssl/pem.h>

#include <algorithm>

#include "common/net/certificates.h"

namespace rayfarm {
namespace {

BioPtr bio_of(const std::string& text) {
  return BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(std::min<std::size_t>(text.size(), 1u << 20))));
}

/// What `write` writes.
template <class Write>
std::string written(Write write, const char* complaint) {
  const BioPtr out(BIO_new(BIO_s_mem()));
  expect_done(write(out.get()) == 1, complaint);
  char* data = nullptr;
  const long size = BIO_get_mem_data(out.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

int no_password(char*, int, int, void*) { return 0; }

}  // namespace

void expect_done(bool done, const char* what) {
  if (!done) throw CertificateError(std::string(what) + ": " + openssl_error());
}

KeyPtr key_in(const std::string& pem) {
  KeyPtr key(PEM_read_bio_PrivateKey(bio_of(pem).get(), nullptr, no_password, nullptr));
  expect_done(key != nullptr, "there is no private key without a password in it");
  return key;
}

CertificatePtr certificate_in(const std::string& pem) {
  CertificatePtr certificate(PEM_read_bio_X509(bio_of(pem).get(), nullptr, no_password, nullptr));
  expect_done(certificate != nullptr, "there is no certificate in it");
  return certificate;
}

RequestPtr request_in(const std::string& pem) {
  RequestPtr request(PEM_read_bio_X509_REQ(bio_of(pem).get(), nullptr, no_password, nullptr));
  expect_done(request != nullptr, "this is no request for a certificate");
  return request;
}

std::string pem_of(EVP_PKEY* key) {
  return written(
      [key](BIO* out) { return PEM_write_bio_PrivateKey(out, key, nullptr, nullptr, 0, nullptr, nullptr); },
      "a key could not be written");
}

std::string pem_of(X509* certificate) {
  return written([certificate](BIO* out) { return PEM_write_bio_X509(out, certificate); },
                 "a certificate could not be written");
}

std::string pem_of(X509_REQ* request) {
  return written([request](BIO* out) { return PEM_write_bio_X509_REQ(out, request); },
                 "a request could not be written");
}

}  // namespace rayfarm
