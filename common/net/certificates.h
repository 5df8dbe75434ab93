// Keys and certificates as text (PEM), and the authority that a farm signs them with.
//
// Each farm has an authority of its own. What it signs says what the owner is to this farm, its master or a worker, so
// that no worker can pass for the master. Keys are on the curve P-256, which browsers know, too; signatures are ECDSA
// with SHA-256.
#pragma once
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rayfarm {

using WallTime = std::chrono::system_clock::time_point;

/// What cannot be a key, a request or a certificate, or a file of them that cannot be used.
struct CertificateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class PeerRole : std::uint8_t { master, worker };
std::string_view name_of(PeerRole role);

/// A private key and the certificate that shows whose it is.
struct Identity {
  std::string key, certificate;
  bool operator==(const Identity&) const = default;
};

struct Owner {
  PeerRole role = PeerRole::worker;
  std::string name;                  // 1 to 64 characters
  std::vector<std::string> hosts{};  // names and addresses under which browsers find it
};
struct Validity {
  WallTime from, until;
};
constexpr std::size_t max_owner_name = 64;  // a limit of the format

/// What a certificate says, whoever signed it.
struct CertificateFacts {
  std::string id;  // SHA-256 of the certificate, hexadecimal
  PeerRole role = PeerRole::worker;
  std::string name;
  std::vector<std::string> hosts;  // sorted
  WallTime from, until;
};

/// The blocks of a text, from each -----BEGIN to its -----END; what stands between is left out.
std::vector<std::string> pem_blocks(std::string_view text);

std::string new_key();
/// Proves that who asks for a certificate has the key.
std::string certificate_request(const std::string& key);
/// An authority that signs for 20 years.
Identity new_authority(WallTime now);
/// A certificate for the key that made the request. Throws CertificateError when the request proves nothing, or the
/// owner's name is too long.
std::string issue(const Identity& authority, const std::string& request, const Owner& owner,
                  Validity validity);

CertificateFacts facts_of(const std::string& certificate);
/// Of the first certificate in the text; CertificateFacts::id of an authority is its fingerprint.
std::string fingerprint_of(const std::string& certificate);
bool is_signed_by(const std::string& certificate, const std::string& authority);
bool is_of_key(const std::string& certificate, const std::string& key);

}  // namespace rayfarm
