// What strangers show as a request for a certificate, or as one.
#include "common/net/certificates.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

void sign(const std::string& request) try {
  static const Identity authority = new_authority(WallTime{});
  issue(authority, request, {PeerRole::worker, "lab7"}, {WallTime{}, WallTime{} + std::chrono::hours(1)});
} catch (const CertificateError&) {}

void read(const std::string& certificate) try { facts_of(certificate); } catch (const CertificateError&) {
}

}  // namespace

void fuzz(ByteView bytes) {
  const std::string text(text_of(bytes));
  sign(text);
  read(text);
  for (const std::string& block : pem_blocks(text)) read(block);
}

}  // namespace rayfarm
