// The keys of a farm in its master's state folder.
#pragma once
#include <filesystem>

#include "common/net/certificates.h"

namespace rayfarm {

// What there is is read, what there is not is made and written. Throw CertificateError or std::runtime_error with the
// file's name.
Identity kept_authority(const std::filesystem::path& file, WallTime now);
/// Made anew when it has less than half of its 820 days left (browsers take no longer ones), is not the authority's, or
/// not for these names and addresses.
Identity kept_master(const std::filesystem::path& file, const Identity& authority,
                     std::vector<std::string> hosts, WallTime now);

}  // namespace rayfarm
