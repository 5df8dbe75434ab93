#include "common/work/crew.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "common/net/codec.h"

namespace rayfarm {
namespace {

FrameId frame_of(const Assignment& assignment) { return {assignment.job, assignment.frame}; }

/// Empty unless the assignment cannot be rendered.
std::string fault_of(const Assignment& assignment, const RenderSettings& settings) {
  const std::uint32_t tiles = tile_count({settings.width, settings.height});
  if (assignment.tile < tiles) return {};
  return "there is no tile " + std::to_string(assignment.tile) + ", the picture has " + std::to_string(tiles);
}

}  // namespace

Crew::Crew(unsigned threads, PrepareScene prepare) : prepare_(std::move(prepare)) {
  for (unsigned i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Crew::~Crew() {
  const Lock lock(mutex_);
  drop_waiting();
  stop_running();
  ending_ = true;
  changed_.notify_all();
}

// What a master says. --------------------------------------------------------------------------------------

void Crew::begin(Answer answer) {
  const Lock lock(mutex_);
  drop_waiting();
  stop_running();
  frames_.clear();
  for (auto& [hash, scene] : scenes_) discard(std::move(scene));
  for (auto& [hash, asset] : assets_) discard(std::move(asset));
  scenes_.clear();
  assets_.clear();
  taking_ = true;
  answer_ = std::move(answer);
}

void Crew::take(const AssetData& asset) {
  const Lock lock(mutex_);
  const auto [known, is_new] = assets_.try_emplace(asset.hash);
  if (!is_new) return;
  known->second = std::make_shared<AssetState>();
  known->second->data = asset;
}

void Crew::take(const AssetEnd& end) {
  const Lock lock(mutex_);
  for (const std::string& hash : end.hashes)
    if (const auto node = assets_.extract(hash)) discard(node.mapped());
}

void Crew::take(const SceneData& scene) {
  const Lock lock(mutex_);
  if (!scenes_.contains(scene.hash))
    scenes_.emplace(scene.hash, std::make_shared<SceneState>(SceneState{scene, {}, {}, {}}));
}

void Crew::take(const FrameStart& start) {
  const Lock lock(mutex_);
  auto found = scenes_.find(start.scene_hash);
  auto scene = found != scenes_.end()
                   ? found->second
                   : std::make_shared<SceneState>(SceneState{{}, {}, {}, "its scene was never sent"});
  Assets assets;
  for (const std::string& hash : start.assets)
    if (const auto asset = assets_.find(hash); asset != assets_.end()) assets.push_back(asset->second);
  frames_.insert_or_assign({start.job, start.settings.frame},
                           Frame{start.settings, std::move(scene), std::move(assets)});
}

void Crew::take(const Assignment& assignment) {
  const Lock lock(mutex_);
  if (!taking_) return give_back(assignment.lease, "");
  const auto frame = frames_.find(frame_of(assignment));
  if (frame == frames_.end()) return give_back(assignment.lease, "its job was never started");
  if (std::string fault = fault_of(assignment, frame->second.settings); !fault.empty())
    return give_back(assignment.lease, std::move(fault));
  waiting_.push_back(assignment);
  changed_.notify_one();
}

void Crew::take(const Revoke& revoke) {
  const Lock lock(mutex_);
  for (const LeaseId lease : revoke.leases) {
    std::erase_if(waiting_, [&](const Assignment& a) { return a.lease == lease; });
    const auto running = running_.find(lease);
    if (running == running_.end()) continue;
    *running->second = true;
    running_.erase(running);
  }
}

void Crew::take(const FrameEnd& end) {
  const Lock lock(mutex_);
  const FrameId id{end.job, end.frame};
  const auto frame = frames_.find(id);
  if (frame == frames_.end()) return;
  std::erase_if(waiting_, [&](const Assignment& a) { return frame_of(a) == id; });
  std::shared_ptr<SceneState> scene = std::move(frame->second.scene);
  frames_.erase(frame);
  if (std::ranges::any_of(frames_, [&](const auto& other) { return other.second.scene == scene; })) return;
  scenes_.erase(scene->data.hash);
  discard(std::move(scene));
}

std::vector<LeaseId> Crew::stop_taking() {
  const Lock lock(mutex_);
  taking_ = false;
  return drop_waiting();
}

std::vector<LeaseId> Crew::abandon() {
  const Lock lock(mutex_);
  taking_ = false;
  std::vector<LeaseId> leases = drop_waiting();
  std::ranges::copy(stop_running(), std::back_inserter(leases));
  return leases;
}

// Under the lock. ------------------------------------------------------------------------------------------

void Crew::give_back(LeaseId lease, std::string reason) { answer_(GiveBack{{lease}, std::move(reason)}); }

void Crew::discard(std::shared_ptr<void> scene_or_asset) {
  discarded_.push_back(std::move(scene_or_asset));
  changed_.notify_one();
}

std::vector<LeaseId> Crew::drop_waiting() {
  std::vector<LeaseId> leases;
  for (const Assignment& assignment : waiting_) leases.push_back(assignment.lease);
  waiting_.clear();
  return leases;
}

std::vector<LeaseId> Crew::stop_running() {
  std::vector<LeaseId> leases;
  for (const auto& [lease, stop] : running_) {
    *stop = true;
    leases.push_back(lease);
  }
  running_.clear();
  return leases;
}

// The threads. ---------------------------------------------------------------------------------------------

void Crew::work() {
  Lock lock(mutex_);
  while (!ending_)
    if (!work_once(lock)) changed_.wait(lock);
}

/// False when there is nothing to do. The lock is open while something is done.
bool Crew::work_once(Lock& lock) {
  if (!discarded_.empty()) {
    auto discarded = std::exchange(discarded_, {});
    lock.unlock();
    discarded.clear();
    lock.lock();
    return true;
  }
  for (auto next = waiting_.begin(); next != waiting_.end(); ++next) {
    Frame frame = frames_.at(frame_of(*next));
    if (frame.scene->preparing) continue;
    if (!frame.scene->is_settled()) {
      prepare(lock, frame);
      return true;
    }
    const Assignment assignment = *next;
    waiting_.erase(next);
    render(lock, assignment, frame);
    discarded_.push_back(std::move(frame.scene));  // who holds it last frees it, and that may be us
    return true;
  }
  return false;
}

const Asset& Crew::AssetState::decoded() {
  std::call_once(once, [this] {
    asset = decode_asset(data);
    data.bytes.reset();
  });
  return asset;
}

TileRenderer Crew::made_ready(const SceneData& scene, const Assets& assets, const PrepareScene& prepare) {
  if (sha256_hex(*scene.bytes) != scene.hash)
    throw CodecError("the scene's bytes do not have the scene's hash");
  std::vector<Asset> decoded;
  for (const auto& asset : assets) decoded.push_back(asset->decoded());
  return prepare(decode_scene(*scene.bytes, decoded));
}

void Crew::prepare(Lock& lock, const Frame& frame) {
  const std::shared_ptr<SceneState>& scene = frame.scene;
  scene->preparing = true;
  const SceneData data = scene->data;
  lock.unlock();
  TileRenderer renderer;
  std::string fault;
  try {
    renderer = made_ready(data, frame.assets, prepare_);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  lock.lock();
  scene->renderer = std::move(renderer);
  scene->fault = std::move(fault);
  scene->data.bytes.reset();
  scene->preparing = false;
  changed_.notify_all();
}

void Crew::render(Lock& lock, const Assignment& assignment, const Frame& frame) {
  if (!frame.scene->fault.empty()) return give_back(assignment.lease, frame.scene->fault);
  const auto stop = std::make_shared<std::atomic<bool>>(false);
  running_.insert_or_assign(assignment.lease, stop);
  lock.unlock();

  std::optional<std::vector<PassImage>> images;
  std::string fault;
  const auto begun = std::chrono::steady_clock::now();
  try {
    images = frame.scene->renderer(frame.settings, assignment.tile, assignment.passes,
                                   [&] { return stop->load(std::memory_order_relaxed); });
  } catch (const std::exception& error) {
    fault = error.what();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;

  lock.lock();
  // Another master may have given the same number to another lease meanwhile.
  const auto running = running_.find(assignment.lease);
  if (running == running_.end() || running->second != stop) return;
  running_.erase(running);
  if (!fault.empty()) return give_back(assignment.lease, std::move(fault));
  assert(images);  // it was never told to stop
  answer_(Result{assignment.lease, assignment.job, assignment.frame, assignment.tile, std::move(*images),
                 took.count()});
}

}  // namespace rayfarm
