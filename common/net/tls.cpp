#include "common/net/tls.h"

#include "common/net/openssl_ptr.h"
#include "common/net/pem.h"

namespace rayfarm {
namespace {

using StorePtr = std::unique_ptr<X509_STORE, FreedBy<X509_STORE_free>>;
using VerificationPtr = std::unique_ptr<X509_STORE_CTX, FreedBy<X509_STORE_CTX_free>>;

/// The handshake takes any certificate, so that the other side learns nothing from its failing: what is shown is
/// judged once it is over, before anything is said.
int take_any(X509_STORE_CTX*, void*) { return 1; }

std::shared_ptr<SSL_CTX> new_context() {
  const std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_method()), SSL_CTX_free);
  expect_done(context && SSL_CTX_set_min_proto_version(context.get(), TLS1_3_VERSION) == 1 &&
                  SSL_CTX_set_ciphersuites(
                      context.get(),
                      "TLS_AES_128_GCM_SHA256:TLS_AES_256_GCM_SHA384:TLS_CHACHA20_POLY1305_SHA256") == 1,
              "TLS 1.3 is not available");
  SSL_CTX_set_num_tickets(context.get(), 0);
  SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
  SSL_CTX_set_options(context.get(), SSL_OP_NO_TICKET | SSL_OP_NO_COMPRESSION);
  // A connection that is idle holds no buffers: a master has a thousand of them.
  SSL_CTX_set_mode(context.get(), SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_set_max_cert_list(context.get(), 16 * 1024);  // bytes that a stranger may send as its chain
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_cert_verify_callback(context.get(), take_any, nullptr);
  return context;
}

void use(SSL_CTX* context, const Identity& own) {
  const KeyPtr key = key_in(own.key);
  expect_done(SSL_CTX_use_certificate(context, certificate_in(own.certificate).get()) == 1 &&
                  SSL_CTX_use_PrivateKey(context, key.get()) == 1,
              "the key and the certificate cannot be used");
}

std::string words_for(long verdict) {
  if (verdict == X509_V_ERR_CERT_HAS_EXPIRED) return "it has expired";
  if (verdict == X509_V_ERR_CERT_NOT_YET_VALID) return "it is not valid yet: is this PC's clock right?";
  if (verdict == X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY ||
      verdict == X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN || verdict == X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT)
    return "it is of another farm";
  return X509_verify_cert_error_string(verdict);
}

/// Why the authorities in the store do not stand behind this certificate; empty when one does.
std::string fault_of(X509* certificate, X509_STORE* authorities) {
  const VerificationPtr verification(X509_STORE_CTX_new());
  expect_done(verification && X509_STORE_CTX_init(verification.get(), authorities, certificate, nullptr) == 1,
              "a certificate could not be verified");
  const bool is_good = X509_verify_cert(verification.get()) == 1;
  ERR_clear_error();
  return is_good ? "" : words_for(X509_STORE_CTX_get_error(verification.get()));
}

}  // namespace

TlsContext::TlsContext(const Identity& own, const std::string& authority, PeerRole peer)
    : context_(new_context()), peer_(peer) {
  const CertificatePtr trusted = certificate_in(authority);
  use(context_.get(), own);
  expect_done(X509_STORE_add_cert(SSL_CTX_get_cert_store(context_.get()), trusted.get()) == 1 &&
                  SSL_CTX_add1_chain_cert(context_.get(), trusted.get()) ==
                      1,  // for those who know its fingerprint only
              "the authority's certificate cannot be used");
}

TlsContext TlsContext::of_stranger() { return TlsContext(new_context()); }

std::shared_ptr<ssl_ctx_st> web_context(const Identity& own) {
  const std::shared_ptr<SSL_CTX> context = new_context();
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_NONE, nullptr);
  const std::vector<std::string> chain = pem_blocks(own.certificate);
  if (chain.empty()) throw CertificateError("there is no certificate");
  use(context.get(), {own.key, chain[0]});
  for (std::size_t i = 1; i < chain.size(); ++i)
    expect_done(SSL_CTX_add1_chain_cert(context.get(), certificate_in(chain[i]).get()) == 1,
                "the certificates cannot be used");
  return context;
}

ssl_ctx_st* share(const std::shared_ptr<ssl_ctx_st>& context) {
  SSL_CTX_up_ref(context.get());
  return context.get();
}

std::optional<PeerCertificate> peer_certificate(ssl_st& connection, const TlsContext& context) {
  const CertificatePtr shown(SSL_get1_peer_certificate(&connection));
  if (!shown) return std::nullopt;
  PeerCertificate peer{facts_of(pem_of(shown.get())),
                       fault_of(shown.get(), SSL_CTX_get_cert_store(context.get()))};
  if (peer.fault.empty() && peer.facts.role != context.peer_role())
    peer.fault = "it is a " + std::string(name_of(peer.facts.role)) + "'s";
  return peer;
}

std::string authority_behind(ssl_st& connection, const std::string& fingerprint) {
  const CertificatePtr shown(SSL_get1_peer_certificate(&connection));
  const STACK_OF(X509)* chain = SSL_get_peer_cert_chain(&connection);
  for (int i = 0; shown && i < sk_X509_num(chain); ++i) {
    X509* const candidate = sk_X509_value(chain, i);
    std::string authority = pem_of(candidate);
    if (!fingerprint_of(authority).starts_with(fingerprint)) continue;
    const StorePtr store(X509_STORE_new());
    expect_done(store && X509_STORE_add_cert(store.get(), candidate) == 1, "the authority cannot be used");
    const std::string fault = fault_of(shown.get(), store.get());
    if (!fault.empty()) throw CertificateError("the certificate of the master cannot be trusted: " + fault);
    if (facts_of(pem_of(shown.get())).role != PeerRole::master)
      throw CertificateError("who answers is not the farm's master");
    return authority;
  }
  throw CertificateError("who answers is not the master that made the code");
}

}  // namespace rayfarm
