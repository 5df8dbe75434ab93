// Meshes, Bezier surfaces and images that were uploaded, before and while jobs need them.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "common/net/messages.h"

namespace rayfarm {

/// From any thread. What a job holds is found again as long as it does; of the others the newest are kept, so that who
/// uploads an asset has time to submit the job.
class AssetStore {
 public:
  /// `bytes`: of assets that no job holds. The newest one is kept, however big.
  explicit AssetStore(std::uint64_t bytes = std::uint64_t{512} << 20) : limit_(bytes) {}

  /// The hash must be that of the bytes. Gives the one that is here already, if there is one.
  AssetData add(AssetData asset);
  std::optional<AssetData> find(const std::string& hash);

 private:
  void keep(const AssetData& asset);

  const std::uint64_t limit_;
  std::mutex mutex_;                                     // guards what follows
  std::map<std::string, SharedBytes::weak_type> known_;  // by hash
  std::deque<AssetData> kept_;                           // the newest last
};

}  // namespace rayfarm
