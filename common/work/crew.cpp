#include "common/work/crew.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "common/net/codec.h"

namespace rayfarm {
namespace {

Size size_of(const RenderSettings& settings) { return {settings.width, settings.height}; }

FrameId frame_of(const Assignment& assignment) { return {assignment.job, assignment.frame}; }

constexpr std::size_t most_kept = 2048;    // 49 kB each
constexpr std::size_t most_answered = 64;  // of a burst that the master had not taken when it was lost

/// Empty unless the assignment cannot be rendered.
std::string fault_of(const Assignment& assignment, const RenderSettings& settings) {
  const std::uint32_t tiles = tile_count(size_of(settings));
  if (assignment.tile < tiles) return {};
  return "there is no tile " + std::to_string(assignment.tile) + ", the picture has " + std::to_string(tiles);
}

}  // namespace

Crew::Crew(unsigned threads, PrepareScene prepare) : prepare_(std::move(prepare)) {
  for (unsigned i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Crew::~Crew() {
  abandon();
  const Lock lock(mutex_);
  ending_ = true;
  changed_.notify_all();
}

// What a master says. --------------------------------------------------------------------------------------

void Crew::begin(Answer answer) {
  const Lock lock(mutex_);
  keep_all();
  frames_.clear();
  for (auto& [hash, scene] : scenes_) discard(std::move(scene));
  for (auto& [hash, asset] : assets_) discard(std::move(asset));
  scenes_.clear();
  assets_.clear();
  taking_ = true;
  answer_ = std::move(answer);
}

void Crew::lose_master() {
  const Lock lock(mutex_);
  keep_all();
}

std::vector<HeldTile> Crew::kept() {
  const Lock lock(mutex_);
  std::vector<HeldTile> held;
  for (const TaskPtr& task : kept_) held.push_back({task->assignment, task->progress == Progress::finished});
  return held;
}

void Crew::forget_kept() {
  const Lock lock(mutex_);
  drop_kept();
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
  if (scenes_.contains(scene.hash)) return;
  const auto is_it = [&](const TaskPtr& task) { return task->frame->scene->data.hash == scene.hash; };
  const auto kept = std::ranges::find_if(kept_, is_it);
  scenes_[scene.hash] = kept != kept_.end() ? (*kept)->frame->scene
                                            : std::make_shared<SceneState>(SceneState{scene, {}, {}, {}});
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
  frames_[{start.job, start.settings.frame}] =
      std::make_shared<const Frame>(Frame{start.settings, std::move(scene), std::move(assets)});
}

void Crew::take(const Assignment& assignment) {
  const Lock lock(mutex_);
  const std::shared_ptr<const Frame> frame = frame_for(assignment);
  if (!frame) return;
  if (const TaskPtr task = take_kept(assignment, *frame)) {
    task->assignment = assignment, task->frame = frame, task->is_kept = false;
    tasks_[assignment.lease] = task;
    if (task->progress == Progress::finished) finish(task);
    return;
  }
  begin(std::make_shared<Task>(assignment, frame, tile_at(size_of(frame->settings), assignment.tile)));
}

void Crew::take(const PieceAssignment& piece) {
  const Lock lock(mutex_);
  const std::shared_ptr<const Frame> frame = frame_for(piece.work);
  if (!frame) return;
  if (!is_piece(piece.area, tile_at(size_of(frame->settings), piece.work.tile)))
    return give_back(piece.work.lease, "the piece is none of the tile's");
  const auto task = std::make_shared<Task>(piece.work, frame, piece.area);
  task->is_piece = true;
  begin(task);
}

void Crew::take(const Revoke& revoke) {
  const Lock lock(mutex_);
  for (const LeaseId lease : revoke.leases) {
    const auto task = tasks_.find(lease);
    if (task == tasks_.end()) continue;
    drop(task->second);
    tasks_.erase(task);
  }
}

void Crew::take(const FrameEnd& end) {
  const Lock lock(mutex_);
  const FrameId id{end.job, end.frame};
  const auto found = frames_.find(id);
  if (found == frames_.end()) return;
  const auto is_of_it = [&](const TaskPtr& task) { return task->frame == found->second; };
  std::erase_if(tasks_, [&](const auto& held) {
    const bool ends = is_of_it(held.second) && held.second->progress == Progress::waiting;
    if (ends) drop(held.second);
    return ends;
  });
  for (const TaskPtr& task : answered_)
    if (is_of_it(task)) discard(task);
  std::erase_if(answered_, is_of_it);
  std::shared_ptr<SceneState> scene = found->second->scene;
  frames_.erase(found);
  if (std::ranges::any_of(frames_, [&](const auto& other) { return other.second->scene == scene; })) return;
  scenes_.erase(scene->data.hash);
  discard(std::move(scene));
}

void Crew::take(const Unneeded& unneeded) {
  const Lock lock(mutex_);
  std::erase_if(kept_, [&](const TaskPtr& task) {
    const bool ends = std::ranges::count(unneeded.leases, task->assignment.lease) != 0;
    if (ends) drop(task);
    return ends;
  });
}

std::vector<LeaseId> Crew::stop_taking() {
  const Lock lock(mutex_);
  taking_ = false;
  drop_kept();
  std::vector<LeaseId> leases;
  for (const TaskPtr& task : std::exchange(waiting_, {})) {
    leases.push_back(task->assignment.lease);
    tasks_.erase(task->assignment.lease);
    discard(task);
  }
  return leases;
}

std::vector<LeaseId> Crew::abandon() {
  const Lock lock(mutex_);
  taking_ = false;
  drop_kept();
  std::vector<LeaseId> leases;
  for (const auto& [lease, task] : std::exchange(tasks_, {})) {
    leases.push_back(lease);
    drop(task);
  }
  return leases;
}

// Under the lock. ------------------------------------------------------------------------------------------

std::shared_ptr<const Crew::Frame> Crew::frame_for(const Assignment& assignment) {
  const auto frame = frames_.find(frame_of(assignment));
  std::string fault;
  if (taking_)
    fault =
        frame == frames_.end() ? "its job was never started" : fault_of(assignment, frame->second->settings);
  if (taking_ && fault.empty()) return frame->second;
  give_back(assignment.lease, std::move(fault));
  return nullptr;
}

void Crew::begin(const TaskPtr& task) {
  tasks_[task->assignment.lease] = waiting_.emplace_back(task);
  changed_.notify_one();
}

void Crew::give_back(LeaseId lease, std::string reason) { answer_(GiveBack{{lease}, std::move(reason)}); }

void Crew::discard(std::shared_ptr<void> what) {
  discarded_.push_back(std::move(what));
  changed_.notify_one();
}

/// Out of what is done; not of the lists that name it.
void Crew::drop(const TaskPtr& task) {
  task->stop = true;
  if (task->progress == Progress::waiting) std::erase(waiting_, task);
  discard(task);
}

/// The leases end, the work goes on.
void Crew::keep_all() {
  const auto keep = [this](const TaskPtr& task) { task->is_piece ? drop(task) : kept_.push_back(task); };
  for (const TaskPtr& task : answered_) keep(task);
  for (const auto& [lease, task] : tasks_) keep(task);
  answered_.clear();
  tasks_.clear();
  for (const TaskPtr& task : kept_) task->is_kept = true;
  for (; kept_.size() > most_kept; kept_.pop_front()) drop(kept_.front());
}

void Crew::drop_kept() {
  for (const TaskPtr& task : std::exchange(kept_, {})) drop(task);
}

/// What has the pixels that are asked for, or is about to; null when there is none.
Crew::TaskPtr Crew::take_kept(const Assignment& wanted, const Frame& frame) {
  const auto found = std::ranges::find_if(kept_, [&](const TaskPtr& task) {
    return task->frame->scene == frame.scene && task->frame->settings == frame.settings &&
           task->assignment.tile == wanted.tile && (task->assignment.passes & wanted.passes) == wanted.passes;
  });
  if (found == kept_.end()) return nullptr;
  const TaskPtr task = *found;
  kept_.erase(found);
  return task;
}

void Crew::finish(const TaskPtr& task) {
  task->progress = Progress::finished;
  if (task->is_kept) return;
  const Assignment& a = task->assignment;
  tasks_.erase(a.lease);
  Result result{a.lease, a.job, a.frame, a.tile, {}, task->seconds};
  for (const PassImage& image : task->images)  // a lost master may have asked for more
    if (a.passes >> image.pass & 1) result.images.push_back(image);
  if (task->is_piece) {
    discard(task);
    return answer_(PieceResult{std::move(result), task->area});
  }
  answered_.push_back(task);
  if (answered_.size() > most_answered) {
    discard(answered_.front());
    answered_.pop_front();
  }
  answer_(std::move(result));
}

void Crew::fail(const TaskPtr& task, std::string reason) {
  if (task->is_kept) {
    std::erase(kept_, task);
  } else {
    tasks_.erase(task->assignment.lease);
    give_back(task->assignment.lease, std::move(reason));
  }
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
    const TaskPtr task = *next;
    const std::shared_ptr<const Frame> frame = task->frame;
    if (frame->scene->preparing) continue;
    if (!frame->scene->is_settled()) {
      prepare(lock, *frame);
    } else {
      waiting_.erase(next);
      render(lock, task);
    }
    discarded_.push_back(task);  // who holds it last frees it, and that may be us
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

void Crew::render(Lock& lock, const TaskPtr& task) {
  // Another master may ask for less meanwhile, and mean the same by another frame.
  const std::shared_ptr<const Frame> frame = task->frame;
  const Assignment assignment = task->assignment;
  if (!frame->scene->fault.empty()) return fail(task, frame->scene->fault);
  task->progress = Progress::running;
  lock.unlock();

  std::optional<std::vector<PassImage>> images;
  std::string fault;
  const auto begun = std::chrono::steady_clock::now();
  try {
    images = frame->scene->renderer(frame->settings, task->area, assignment.passes,
                                    [&] { return task->stop.load(std::memory_order_relaxed); });
  } catch (const std::exception& error) {
    fault = error.what();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;

  lock.lock();
  if (task->stop) return;
  if (!fault.empty()) return fail(task, std::move(fault));
  assert(images);  // it was never told to stop
  task->images = std::move(*images), task->seconds = took.count();
  finish(task);
}

}  // namespace rayfarm
