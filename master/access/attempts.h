// How often somebody may be wrong: a secret of 96 bits cannot be guessed, but the log can be filled.
#pragma once
#include <algorithm>
#include <chrono>
#include <map>
#include <string>

#include "common/net/certificates.h"

namespace rayfarm {

class Attempts {
 public:
  /// Whether what comes from this address is looked at.
  bool are_open_to(const std::string& address, WallTime now) const {
    const auto found = wrong_.find(address);
    return found == wrong_.end() || now >= found->second.since + memory || found->second.count < most_wrong;
  }
  void count_wrong(const std::string& address, WallTime now) {
    std::erase_if(wrong_, [&](const auto& entry) { return now >= entry.second.since + memory; });
    if (wrong_.size() >= most_addresses && !wrong_.contains(address)) return;
    Wrong& wrong = wrong_.try_emplace(address, Wrong{now, 0}).first->second;
    ++wrong.count;
  }

 private:
  struct Wrong {
    WallTime since;
    int count = 0;
  };
  static constexpr int most_wrong = 10;  // in a minute
  static constexpr auto memory = std::chrono::minutes(1);
  static constexpr std::size_t most_addresses = 4096;

  std::map<std::string, Wrong> wrong_;
};

}  // namespace rayfarm
