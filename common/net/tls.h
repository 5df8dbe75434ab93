// What one side brings to a TLS 1.3 connection: its certificate, and whom it takes for what.
//
// Only TLS 1.3, without resumption (a revoked certificate must not come back on an old ticket) and, as it has none,
// without renegotiation.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "common/net/certificates.h"

struct ssl_ctx_st;  // OpenSSL's
struct ssl_st;
struct x509_store_st;

namespace rayfarm {

/// Shared by all connections that are made with it.
class TlsContext {
 public:
  /// Shows `own` and trusts certificates that the authority signed for `peer`. Throws CertificateError.
  TlsContext(const Identity& own, const std::string& authority, PeerRole peer);
  /// Of one that has no certificate yet: it shows none, and looks at what it is shown itself.
  static TlsContext of_stranger();

  ssl_ctx_st* get() const { return context_.get(); }
  std::optional<PeerRole> peer_role() const { return peer_; }

 private:
  explicit TlsContext(std::shared_ptr<ssl_ctx_st> context) : context_(std::move(context)) {}

  std::shared_ptr<ssl_ctx_st> context_;
  std::optional<PeerRole> peer_;  // none: of a stranger
};

/// Of a web server, which shows its certificate (and those after it in the text) and asks for none.
std::shared_ptr<ssl_ctx_st> web_context(const Identity& own);
/// The other owner of the context, which must be freed.
ssl_ctx_st* share(const std::shared_ptr<ssl_ctx_st>& context);

/// What the other side of an encrypted connection has shown, and proved that it has the key of.
struct PeerCertificate {
  CertificateFacts facts;
  std::string
      fault;  // why it is not to be believed; empty: the authority signed it, for the role that was wanted
};
/// None when it showed no certificate, as only a side that dials may.
std::optional<PeerCertificate> peer_certificate(ssl_st& connection, const TlsContext& context);

/// The authority with this fingerprint (64 hexadecimal digits or the first ones of them) that stands behind the master
/// at the other side, as text. Throws CertificateError when it is another master, or none.
std::string authority_behind(ssl_st& connection, const std::string& fingerprint);

}  // namespace rayfarm
