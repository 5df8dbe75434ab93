#include "master/http/frame_feeder.h"

#include <nlohmann/json.hpp>

#include "common/net/codec.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr auto full_pause = std::chrono::milliseconds(200);  // until a full farm is asked again

enum class Taken { yes, not_now, never };

Taken brought(const FarmDoor& farm, FrameId id, const SceneData& scene,
              const std::vector<AssetData>& assets) try {
  const bool goes_on =
      farm.ask([=](Farm& f, FarmTime now) { return f.add_frame(id, scene.hash, scene.bytes, now, assets); });
  return goes_on ? Taken::yes : Taken::never;
} catch (const FarmFull&) {
  return Taken::not_now;
} catch (const NotKept&) {
  return Taken::yes;  // its job is paused, and says why
}

}  // namespace

// As CBOR: a script may have any bytes, and JSON's texts may not.
std::string kept_script(const ScriptRequest& script) {
  json kept{{"name", script.name},
            {"text", script.text},
            {"params", script.params},
            {"folder", script.folder.string()}};
  if (const auto& animation = script.animation)
    kept["animation"] = {animation->start, animation->stop, animation->fps};
  std::string bytes;
  json::to_cbor(kept, bytes);
  return bytes;
}

ScriptRequest script_kept_as(const std::string& kept) {
  const json script = json::from_cbor(kept);
  ScriptRequest request{script.at("name"), script.at("text"), script.at("params"), 0, {}, {}};
  request.folder = script.at("folder").get<std::string>();
  if (script.contains("animation")) {
    const json& numbers = script["animation"];
    request.animation = Animation{numbers.at(0), numbers.at(1), numbers.at(2)};
  }
  return request;
}

FrameFeeder::FrameFeeder(const FarmDoor& farm) : farm_(farm), thread_([this] { work(); }) {}

FrameFeeder::~FrameFeeder() {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  changed_.notify_one();
}

void FrameFeeder::feed(JobId job, ScriptRequest script, FrameRange frames) {
  const std::lock_guard lock(mutex_);
  feeds_.push_back({job, std::move(script), frames, 1});
  changed_.notify_one();
}

void FrameFeeder::feed_on(const Farm& farm, FarmTime now) {
  const std::lock_guard lock(mutex_);
  for (const JobView& job : farm.jobs(now))
    if (const std::string script = farm.script(job.id);
        !script.empty() && job.frames_sent < job.frames.count())
      feeds_.push_back({job.id, script_kept_as(script), job.frames, job.frames_sent});
  changed_.notify_one();
}

void FrameFeeder::work() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    if (feeds_.empty()) {
      changed_.wait(lock);
      continue;
    }
    Feed feed = std::move(feeds_.front());
    feeds_.pop_front();
    lock.unlock();
    const bool goes_on = feed_one(feed);
    lock.lock();
    if (goes_on) feeds_.push_back(std::move(feed));
  }
}

/// False when there is nothing more to bring.
bool FrameFeeder::feed_one(Feed& feed) try {
  feed.script.frame = feed.frames.at(feed.place);
  const ScriptResult result = evaluate(feed.script, {}, [this] { return ending_.load(); });
  const auto bytes = std::make_shared<const Bytes>(encode_scene(result.scene));
  const SceneData scene{sha256_hex(*bytes), bytes};
  Taken taken = Taken::not_now;
  while (taken == Taken::not_now) {
    taken = brought(farm_, {feed.job, feed.script.frame}, scene, result.assets);
    std::unique_lock lock(mutex_);
    if (taken == Taken::not_now && changed_.wait_for(lock, full_pause, [this] { return ending_.load(); }))
      return false;
  }
  return taken == Taken::yes && ++feed.place < feed.frames.count();
} catch (const FarmUnavailable&) {
  return !ending_;
} catch (const std::exception& error) {
  if (!ending_) give_up(feed, error.what());
  return false;
}

void FrameFeeder::give_up(const Feed& feed, const std::string& reason) try {
  const std::string why = "frame " + std::to_string(feed.script.frame) + ": " + reason;
  farm_.ask([job = feed.job, why](Farm& f, FarmTime now) { return f.fail(job, why, now); });
} catch (const FarmUnavailable&) {  // there is nobody to be told
}

}  // namespace rayfarm
