// Keys and certificates as PEM text (RFC 7468) and back. What cannot be done throws CertificateError with OpenSSL's
// reason; a file that asks for a password is refused, never asked about.
#pragma once
#include <string>

#include "common/net/openssl_ptr.h"

namespace rayfarm {

/// What a call of OpenSSL came to: throws CertificateError unless it is done.
void expect_done(bool done, const char* what);

KeyPtr key_in(const std::string& pem);
CertificatePtr certificate_in(const std::string& pem);
RequestPtr request_in(const std::string& pem);

std::string pem_of(EVP_PKEY* key);
std::string pem_of(X509* certificate);
std::string pem_of(X509_REQ* request);

}  // namespace rayfarm
