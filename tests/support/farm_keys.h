// The keys of a farm that a test made up.
#pragma once
#include "common/net/dial.h"

namespace rayfarm {

struct FarmKeys {
  const WallTime now = std::chrono::system_clock::now();
  const Validity validity{now, now + std::chrono::hours(1)};
  const Identity authority = new_authority(now);

  Identity identity(PeerRole role, const std::string& name, Validity valid) const {
    const std::string key = new_key();
    return {key, issue(authority, certificate_request(key), {role, name}, valid)};
  }
  Identity identity(PeerRole role, const std::string& name) const { return identity(role, name, validity); }

  /// What a side brings that takes no plaintext, on loopback neither.
  Security of_master(const Identity& own) const {
    return {Exposure::closed, TlsContext(own, authority.certificate, PeerRole::worker)};
  }
  Security of_master() const { return of_master(identity(PeerRole::master, "the master")); }
  Security of_worker(const Identity& own) const {
    return {Exposure::closed, TlsContext(own, authority.certificate, PeerRole::master)};
  }
  Security of_worker(const std::string& name) const { return of_worker(identity(PeerRole::worker, name)); }
};

}  // namespace rayfarm
