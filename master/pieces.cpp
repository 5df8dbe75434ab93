// Tiles that are shared: pieces go out to threads that have nothing else to do, and come back as one result.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

FarmTime farm_time(double seconds) {
  return std::chrono::duration_cast<FarmTime>(std::chrono::duration<double>(seconds));
}

std::uint64_t pixels_in(const Tile& area, PassSet passes) {
  std::uint64_t pixels = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (passes >> pass & 1) pixels += pixel_count(area, pass);
  return pixels;
}

/// It is there, and of no use.
void waste(Job& job, const Split::Piece& piece) {
  job.time_wasted += piece.taken;
  for (const PassImage& image : piece.images) job.rays_wasted += image.counters.rays();
}

/// Somebody renders a piece of it.
bool is_in_work(const Split& split) {
  return std::ranges::any_of(split.pieces,
                             [](const Split::Piece& p) { return !p.is_waiting && p.images.empty(); });
}

}  // namespace

bool Farm::State::share_stragglers(const Job& job, const std::vector<Held>& held,
                                   const std::vector<Helper>& helpers, FarmTime now) {
  if (!std::holds_alternative<std::monostate>(job.spec.verification)) return false;
  std::vector<IdleWorker> idle;
  for (const Helper& helper : helpers) {
    const Worker& worker = *helper.worker;
    if (helper.is_idle && worker.info.takes_pieces && !refuses(worker, job.id))
      idle.push_back({static_cast<std::uint64_t>(worker.id), expected_speed(worker, job), helper.threads, 0});
  }
  if (idle.empty()) return false;

  const auto may_be_finished = [this](const Lease& lease) {
    return lease.is_reattached ||
           (lease.twin && workers.at(lease.twin->worker).leases.at(lease.twin->lease).is_reattached);
  };
  // Of work that is done twice, the lease that will be there first.
  std::map<LeaseId, double> left;
  for (const Held& h : held) left[h.id] = h.straggler.time_left;
  std::vector<const Held*> shareable;
  std::vector<Straggler> stragglers;
  for (const Held& h : held) {
    const Lease& lease = *h.lease;
    if (lease.piece || lease.split || may_be_finished(lease)) continue;
    if (lease.twin &&
        std::pair(left.at(lease.twin->lease), lease.twin->lease) < std::pair(left.at(h.id), h.id))
      continue;
    shareable.push_back(&h);
    stragglers.push_back(h.straggler);
  }
  const std::vector<Share> shares = shares_of(stragglers, idle);
  for (const Share& share : shares) split(*shareable[share.straggler], share.pieces, now);
  // In rounds, so that all idle workers get some.
  bool anybody_took = !shares.empty();
  while (anybody_took) {
    anybody_took = false;
    for (auto& [id, worker] : workers) anybody_took |= give_share(worker, next_job_for(worker), now);
  }
  return !shares.empty();
}

void Farm::State::split(const Held& straggler, std::uint32_t pieces, FarmTime now) {
  Worker& holder = workers.at(WorkerId{straggler.straggler.holder});
  Lease& lease = holder.leases.at(straggler.id);
  Job& job = jobs.at(lease.job);
  if (lease.twin) end_twin(*std::exchange(lease.twin, {}), now);

  const SplitId id{++last_split};
  Split& split = splits[id];
  split.frame = {lease.job, lease.frame}, split.work = lease.work;
  for (const Tile& area : pieces_of(tile_at(size_of(job.spec.settings), lease.work.tile), pieces))
    if (pixels_in(area, lease.work.passes) > 0) split.pieces.push_back({area});
  split.missing = split.pieces.size();
  splits_to_share.insert(id);
  split.expected = now + farm_time(straggler.straggler.time_left);
  ++job.tiles_shared;
  touch(job);
  if (is_hardly_begun(straggler.straggler)) {
    call_off(holder, straggler.id, now);
    holder.send(Revoke{{straggler.id}});
  } else {
    lease.split = id;
    split.original = {holder.id, straggler.id};
  }
}

bool Farm::State::give_share(Worker& worker, const Job* other, FarmTime now) {
  if (splits.empty() || !may_work(worker) || worker.leases.size() >= worker.info.threads) return false;
  if (worker.info.takes_pieces) return give_some_piece(worker, other, now);
  for (const auto& [id, split] : splits) {
    if (!may_share(worker, split, other) || !may_go_whole(id, now)) continue;
    give_whole(worker, id, now);
    return true;
  }
  return false;
}

bool Farm::State::may_share(const Worker& worker, const Split& split, const Job* other) const {
  const Job& job = jobs.at(split.frame.job);
  const bool is_next = other == nullptr || job.spec.priority >= other->spec.priority;
  return job.state == JobState::running && !refuses(worker, job.id) && is_next;
}

bool Farm::State::give_some_piece(Worker& worker, const Job* other, FarmTime now) {
  for (auto next = splits_to_share.begin(); next != splits_to_share.end();) {
    const SplitId id = *next;
    const auto found = splits.find(id);
    const auto waiting = [&] {
      return std::ranges::find(found->second.pieces, true, &Split::Piece::is_waiting);
    };
    if (found == splits.end() || waiting() == found->second.pieces.end()) {
      next = splits_to_share.erase(next);
      continue;
    }
    ++next;
    const Split& split = found->second;
    if (!may_share(worker, split, other)) continue;
    const Job& job = jobs.at(split.frame.job);
    const double whole = expected_seconds(expected_rays(job, *frame_of(job, split.frame.frame), split.work),
                                          expected_speed(worker, job));
    const FarmTime seconds = farm_time(whole / static_cast<double>(split.pieces.size()));
    // Not to one so slow that who has the whole tile will be there first; that one may be late.
    if (split.original && now < split.expected && now + seconds > split.expected) continue;
    give_piece(worker, id, static_cast<std::size_t>(waiting() - found->second.pieces.begin()), now);
    return true;
  }
  return false;
}

void Farm::State::give_piece(Worker& worker, SplitId id, std::size_t place, FarmTime now) {
  Split& split = splits.at(id);
  Job& job = jobs.at(split.frame.job);
  Split::Piece& piece = split.pieces[place];
  piece.is_waiting = false;
  introduce(worker, job, frame_at(job, split.frame.frame));
  Lease lease{job.id, split.frame.frame, split.work,
              pixels_in(piece.area, split.work.passes) * job.spec.settings.spp, now};
  lease.piece = {id, place, piece.area};
  assign(worker, LeaseId{++last_lease}, std::move(lease));
}

bool Farm::State::is_doubled(SplitId id) const {
  return std::ranges::any_of(workers, [id](const auto& worker) {
    return std::ranges::any_of(worker.second.leases, [id](const auto& held) {
      const Lease& lease = held.second;
      return lease.piece && lease.piece->split == id && lease.twin;
    });
  });
}

bool Farm::State::may_go_whole(SplitId id, FarmTime now) const {
  const Split& split = splits.at(id);
  if (split.original) return false;
  return !is_in_work(split) || (now > split.expected && !is_doubled(id));
}

void Farm::State::give_whole(Worker& worker, SplitId id, FarmTime now) {
  Split& split = splits.at(id);
  Job& job = jobs.at(split.frame.job);
  JobFrame& frame = frame_at(job, split.frame.frame);
  introduce(worker, job, frame);
  Lease lease{job.id, split.frame.frame, split.work,
              pixels_in(split.work, job.spec.settings) * job.spec.settings.spp, now};
  lease.split = id;
  const double cost = expected_rays(job, frame, split.work);
  split.original = {worker.id, LeaseId{++last_lease}};
  split.expected = now + farm_time(expected_seconds(cost, expected_speed(worker, job)));
  assign(worker, LeaseId{last_lease}, std::move(lease));
}

void Farm::State::hear_piece(Worker& worker, const Lease& lease, Result result, FarmTime now) {
  const FarmTime taken = book(worker, lease, result, now);
  Split& split = splits.at(lease.piece->split);
  Split::Piece& piece = split.pieces[lease.piece->place];
  piece.images = std::move(result.images);
  piece.by = worker.name, piece.worker = worker.id, piece.taken = taken;
  if (--split.missing == 0) put_together(lease.piece->split, worker, now);
}

void Farm::State::put_together(SplitId id, Worker& last, FarmTime now) {
  Split split = std::move(splits.extract(id).mapped());
  if (split.original) end_twin(*split.original, now);
  Job& job = jobs.at(split.frame.job);
  JobFrame& frame = frame_at(job, split.frame.frame);
  std::vector<Tile> areas;
  std::vector<std::vector<PassImage>> images;
  std::vector<NameId> helpers;
  FarmTime taken{};
  for (Split::Piece& piece : split.pieces) {
    areas.push_back(piece.area);
    images.push_back(std::move(piece.images));
    taken += piece.taken;
    if (const auto worker = workers.find(piece.worker); worker != workers.end())
      credit(worker->second, pixels_in(piece.area, split.work.passes));
    if (piece.by != last.name && std::ranges::count(helpers, piece.by) == 0) helpers.push_back(piece.by);
  }
  const Tile tile = tile_at(size_of(job.spec.settings), split.work.tile);
  accept(job, frame, split.work, assembled(tile, areas, images), last.name, taken, now, helpers);
}

void Farm::State::end_split(SplitId id, FarmTime now) {
  const Split split = std::move(splits.extract(id).mapped());
  Job& job = jobs.at(split.frame.job);
  for (const Split::Piece& piece : split.pieces) rayfarm::waste(job, piece);
  for (auto& [worker_id, worker] : workers) {
    Revoke revoke;
    for (const auto& [lease_id, lease] : worker.leases)
      if (lease.piece && lease.piece->split == id) revoke.leases.push_back(lease_id);
    for (const LeaseId lease : revoke.leases) waste(job, worker, call_off(worker, lease, now), now);
    if (!revoke.leases.empty()) worker.send(std::move(revoke));
  }
  touch(job);
}

void Farm::State::drop_splits(FrameId frame, FarmTime now) {
  std::vector<SplitId> ids;
  for (const auto& [id, split] : splits)
    if (split.frame == frame) ids.push_back(id);
  for (const SplitId id : ids) {
    if (const auto original = splits.at(id).original) end_twin(*original, now);
    end_split(id, now);
  }
}

void Farm::State::lose_pieces_of(const KnownWorker& worker) {
  for (auto& [id, split] : splits)
    for (Split::Piece& piece : split.pieces) {
      if (piece.images.empty() || std::ranges::count(worker.names, piece.by) == 0) continue;
      Job& job = jobs.at(split.frame.job);
      rayfarm::waste(job, piece);
      touch(job);
      piece = {piece.area};
      ++split.missing;
      splits_to_share.insert(id);
    }
}

}  // namespace rayfarm
