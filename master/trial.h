// Work whose pixels are believed only when several agree on them.
#pragma once
#include <optional>
#include <vector>

#include "master/farm.h"
#include "master/job.h"
#include "master/schedule.h"

namespace rayfarm {

struct TrialId {
  FrameId frame;
  std::uint32_t tile = 0;
  PassSet passes = 0;
  auto operator<=>(const TrialId&) const = default;
};

/// What one worker says that the pixels are.
struct Opinion {
  NameId by{};
  std::string identity{};
  std::uint64_t process = 0;
  bool is_final = false;  // the master's own threads are believed
  std::vector<PassImage> images;
  FarmTime taken{};
};

struct Trial {
  /// Who has a lease to say its opinion.
  struct Asked {
    WorkerId worker{};
    LeaseId lease{};
  };
  std::uint32_t wanted = 2;  // that must agree
  std::vector<Opinion> opinions;
  std::vector<Asked> asked;
  std::vector<Asked> overdue;  // may still answer, but are not waited for
};

/// The place of the first opinion of those that are right, once that is known: one is final, or enough agree.
std::optional<std::size_t> verdict(const Trial& trial);
/// Whether pixels and counters have the same bits.
bool agree(const Opinion& a, const Opinion& b);
/// Whether more are to be asked than are asked already.
bool wants_opinions(const Trial& trial);
/// Whether no more are asked than are wanted: one beyond that may save the others' waiting for who never answers.
bool bears_another_opinion(const Trial& trial);

}  // namespace rayfarm
