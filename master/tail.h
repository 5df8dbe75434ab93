// The tail: what is expected to end after all that still waits is done a second time, by threads that are sooner; whose
// result comes first is taken.
//
// Source: J. Dean, S. Ghemawat, MapReduce: Simplified Data Processing on Large Clusters, OSDI 2004, section 3.6 (backup
// tasks); M. Zaharia et al., Improving MapReduce Performance in Heterogeneous Environments, OSDI 2008 (the one that is
// expected to end last goes first).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace rayfarm {

/// Seconds that one thread takes for the cost in rays at a speed in rays a second; half a second when either is 0, which
/// stands for unknown.
double expected_seconds(double cost, double speed);

/// Work that a worker holds.
struct HeldWork {
  double expected = 0;            // seconds of one of its threads
  std::optional<double> spent{};  // seconds since it was begun; none: it waits for a thread
};
/// Seconds until each is there. `held` is in the order in which it is begun, on so many threads, at least 1. What is
/// late by some time is expected to be late by as much again.
std::vector<double> times_left(std::span<const HeldWork> held, std::uint32_t threads);

/// Whether nobody should wait for it any longer: after 20 times what was expected, and no less than the 2 s within which a
/// silent worker is lost.
bool is_stuck(const HeldWork& work);

/// Work of one job that one worker holds, and no other.
struct Straggler {
  std::uint64_t holder = 0;
  double time_left = 0;           // seconds
  double cost = 0;                // rays; 0: unknown
  std::optional<double> spent{};  // seconds since it was begun; none: it waits for a thread
  bool is_piece = false;          // of a tile
};
/// Their places in the list.
std::vector<std::size_t> latest_first(std::span<const Straggler> stragglers);
struct IdleWorker {
  std::uint64_t id = 0;
  double speed = 0;           // rays a second of one thread; 0: unknown
  std::uint32_t threads = 0;  // that may take one each
  double busy = 0;            // seconds until they can begin
  bool takes_pieces = true;
};
/// Who does what again, by their places in the lists.
struct Copy {
  std::size_t straggler = 0, worker = 0;
  bool operator==(const Copy&) const = default;
};
/// When the first thread has nothing more to do, in seconds: of a worker that holds work which takes so long to end.
double time_until_free(std::vector<double> times_left, std::uint32_t threads);
/// What ends last first, by the fastest that has a thread free, can do it and would be sooner; never by its holder. O(n log n).
std::vector<Copy> copies_of(std::span<const Straggler> stragglers, std::span<const IdleWorker> idle);

}  // namespace rayfarm
