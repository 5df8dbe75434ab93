#include "master/worker.h"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace rayfarm {
namespace {

constexpr std::uint32_t spare_leases = 2;  // beside one a thread: the next tile is there when one ends
constexpr double seconds_of_work = 0.25;   // hides the journey of a tile, and is soon given back
constexpr std::size_t most_leases = 1024;  // however fast: what a lost worker costs stays small

bool knows_scene(const Worker& worker, const std::string& hash) {
  return std::ranges::any_of(worker.frames, [&](const auto& known) { return known.second == hash; });
}

}  // namespace

std::string identity_of(const std::string& wanted_name, const std::string& certificate) {
  return certificate.empty() ? "name " + wanted_name : certificate;  // an id has no space in it
}

bool may_work(const Worker& worker) { return !worker.is_drained && !worker.is_stopping; }

bool refuses(const Worker& worker, JobId job) {
  const auto known = worker.jobs.find(job);
  return known != worker.jobs.end() && known->second.is_refused;
}

bool may_be_given(const Worker& worker, JobId job) {
  return may_work(worker) && !refuses(worker, job) && worker.leases.size() < most_leases;
}

std::size_t leases_at_hand(const Worker& worker) { return std::size_t{worker.info.threads} + spare_leases; }

bool has_room_for(const Worker& worker, JobId job) {
  const std::uint32_t threads = worker.info.threads;
  if (worker.leases.size() >= most_leases) return false;
  const bool is_new = worker.tiles == 0;  // who knows how long it will take
  if (worker.leases.size() < (is_new ? threads : leases_at_hand(worker))) return true;
  const auto known = worker.jobs.find(job);
  if (known == worker.jobs.end()) return false;
  const double samples_per_second = known->second.speed.per_second() * threads;
  return static_cast<double>(worker.samples_held) < seconds_of_work * samples_per_second;
}

WorkerView view_of(const Worker& worker) {
  WorkerView view;
  view.id = worker.id;
  view.info = worker.info;
  view.state = worker.is_drained       ? WorkerState::drained
               : worker.leases.empty() ? WorkerState::idle
                                       : WorkerState::busy;
  view.leases = static_cast<std::uint32_t>(worker.leases.size());
  view.tiles = worker.tiles, view.pixels = worker.pixels;
  view.samples_per_second = worker.speed.per_second() * worker.info.threads;
  view.joined = worker.joined;
  return view;
}

void introduce(Worker& worker, const Job& job, const JobFrame& frame) {
  const FrameId id{job.id, frame.number};
  if (worker.frames.contains(id)) return;
  std::vector<std::string> assets;
  for (const AssetData& asset : frame.assets) {
    if (worker.assets.insert(asset.hash).second) worker.send(asset);
    assets.push_back(asset.hash);
  }
  if (!knows_scene(worker, frame.scene_hash)) worker.send(SceneData{frame.scene_hash, frame.scene_bytes});
  worker.send(FrameStart{job.id, frame.scene_hash, settings_of(job, frame), std::move(assets)});
  worker.frames[id] = frame.scene_hash;
  worker.jobs[job.id];
}

void forget(Worker& worker, FrameId frame) {
  if (worker.frames.erase(frame) != 0) worker.send(FrameEnd{frame.job, frame.frame});
}

void forget_assets(Worker& worker, const std::set<std::string>& needed) {
  AssetEnd end;
  std::ranges::set_difference(worker.assets, needed, std::back_inserter(end.hashes));
  if (end.hashes.empty()) return;
  for (const std::string& hash : end.hashes) worker.assets.erase(hash);
  worker.send(std::move(end));
}

void assign(Worker& worker, LeaseId id, Lease lease) {
  if (worker.leases.size() < worker.info.threads) lease.begun = lease.given;
  worker.leases.emplace(id, lease);
  worker.samples_held += lease.samples;
  const Assignment assignment{id, lease.job, lease.frame, lease.work.tile, lease.work.passes};
  if (lease.piece)
    worker.send(PieceAssignment{assignment, lease.piece->area});
  else
    worker.send(assignment);
}

Lease take_lease(Worker& worker, LeaseId id, FarmTime now) {
  const auto held = worker.leases.find(id);
  assert(held != worker.leases.end());
  const Lease lease = held->second;
  worker.leases.erase(held);
  worker.samples_held -= lease.samples;
  // They are begun in the order in which they were given, and a thread is free for the next.
  if (worker.leases.size() >= worker.info.threads) {
    const auto last_begun = std::next(worker.leases.begin(), worker.info.threads - std::ptrdiff_t{1});
    if (!last_begun->second.begun) last_begun->second.begun = now;
  }
  return lease;
}

Lease call_off(Worker& worker, LeaseId id, FarmTime now) {
  const Lease lease = take_lease(worker, id, now);
  worker.called_off[id] = lease;
  if (worker.called_off.size() > most_leases) {
    worker.forgotten = worker.called_off.begin()->first;
    worker.called_off.erase(worker.called_off.begin());
  }
  return lease;
}

FarmTime believed_time(const Lease& lease, double seconds, FarmTime now) {
  const double longest = std::chrono::duration<double>(now - lease.given).count();
  const double believed = seconds > 0 ? std::min(seconds, longest) : 0;  // not of a NaN, either
  return std::chrono::duration_cast<FarmTime>(std::chrono::duration<double>(believed));
}

void learn_speed(Worker& worker, const Lease& lease, std::uint64_t rays, FarmTime taken) {
  worker.speed.add(lease.samples, taken);
  worker.tracing.add(rays, taken);
  const auto known = worker.jobs.find(lease.job);
  if (known == worker.jobs.end()) return;
  known->second.speed.add(lease.samples, taken);
  known->second.tracing.add(rays, taken);
}

double tracing_speed(const Worker& worker, JobId job) {
  const auto known = worker.jobs.find(job);
  const double of_job = known == worker.jobs.end() ? 0 : known->second.tracing.per_second();
  return of_job > 0 ? of_job : worker.tracing.per_second();
}

double expected_speed(const Worker& worker, const Job& job) {
  if (const double own = tracing_speed(worker, job.id); own > 0) return own;
  const double seconds = std::chrono::duration<double>(job.thread_time).count();
  return seconds > 0 ? static_cast<double>(job.counters.rays()) / seconds : 0;
}

FarmTime time_wasted(const Lease& lease, FarmTime now) {
  return lease.begun ? now - *lease.begun : FarmTime{};
}

}  // namespace rayfarm
