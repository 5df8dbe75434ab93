// What a worker was given by the farm that it belongs to, kept in its state folder.
#pragma once
#include <filesystem>
#include <optional>

#include "common/net/address.h"
#include "common/net/certificates.h"

namespace rayfarm {

struct Pairing {
  Identity own;
  std::string authority;  // certificate
  Address master;         // where it was paired
  bool operator==(const Pairing&) const = default;
};

/// Nothing when this PC was never paired. Throws std::runtime_error with the file's name and the fix.
std::optional<Pairing> read_pairing(const std::filesystem::path& state);
/// Makes the folder, so that write_pairing() will find room there: a code that was used for nothing is lost. Throws
/// std::runtime_error with the fix.
void make_room_for_pairing(const std::filesystem::path& state);
/// Throws std::runtime_error.
void write_pairing(const std::filesystem::path& state, const Pairing& pairing);

/// Where a worker keeps its state unless it is told: for root /var/lib/rayfarm-worker, as its service does, else
/// rayfarm-worker in the user's XDG_STATE_HOME.
std::filesystem::path default_worker_state();

}  // namespace rayfarm
