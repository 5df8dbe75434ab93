// The farm as people see it.
#include <array>
#include <numeric>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

constexpr std::array<std::string_view, 6> job_state_names{"waiting", "running",   "paused",
                                                          "done",    "cancelled", "failed"};
constexpr std::array<std::string_view, 3> worker_state_names{"idle", "busy", "drained"};

}  // namespace

std::string_view name_of(JobState state) { return job_state_names.at(static_cast<std::size_t>(state)); }
std::string_view name_of(WorkerState state) { return worker_state_names.at(static_cast<std::size_t>(state)); }

std::vector<JobView> Farm::jobs(FarmTime now) const {
  std::vector<JobView> views;
  views.reserve(state_->jobs.size());
  for (const auto& [id, job] : state_->jobs) views.push_back(state_->view(job, now));
  return views;
}

std::optional<JobView> Farm::job(JobId id, FarmTime now) const {
  const auto job = state_->jobs.find(id);
  if (job == state_->jobs.end()) return std::nullopt;
  return state_->view(job->second, now);
}

bool Farm::was_here(JobId id) const {
  const auto number = static_cast<std::uint64_t>(id);
  return number > 0 && number <= state_->last_job && !state_->jobs.contains(id);
}

JobView Farm::State::view(const Job& job, FarmTime now) const {
  JobView view = view_of(job, now);
  if (view.message.empty()) view.message = words_for_trials(job);
  return view;
}

std::vector<WorkerView> Farm::workers() const {
  std::vector<WorkerView> views;
  views.reserve(state_->workers.size());
  for (const auto& [id, worker] : state_->workers) {
    views.push_back(view_of(worker));
    if (const auto known = state_->known_workers.find(worker.identity); known != state_->known_workers.end())
      views.back().trust = known->second.trust;
  }
  return views;
}

std::string Farm::name_of_worker(WorkerId id) const {
  const auto worker = state_->workers.find(id);
  return worker == state_->workers.end() ? std::string() : worker->second.info.name;
}

std::vector<FrameView> Farm::frames(JobId id, FarmTime now) const {
  const auto job = state_->jobs.find(id);
  std::vector<FrameView> views;
  if (job == state_->jobs.end()) return views;
  for (std::uint32_t place = 0; place < job->second.spec.frames->count(); ++place)
    views.push_back(view_of(job->second, place, now));
  return views;
}

std::optional<FrameView> Farm::frame(JobId id, std::optional<std::uint32_t> frame, FarmTime now) const {
  const auto job = state_->jobs.find(id);
  if (job == state_->jobs.end()) return std::nullopt;
  const FrameRange& range = *job->second.spec.frames;
  const auto place = range.index_of(frame.value_or(range.first));
  if (!place) return std::nullopt;
  return view_of(job->second, *place, now);
}

std::shared_ptr<const Film> Farm::film(JobId id, std::optional<std::uint32_t> number) const {
  const JobFrame* frame = state_->picture(id, number);
  return frame ? frame->canvas->film : nullptr;
}

std::optional<Deliveries> Farm::deliveries(JobId id, std::optional<std::uint32_t> number) const {
  const JobFrame* frame = state_->picture(id, number);
  if (!frame) return std::nullopt;
  const Canvas& canvas = *frame->canvas;
  Deliveries all;
  all.losses = frame->losses, all.is_final = has_ended(state_->jobs.at(id));
  all.tiles.reserve(canvas.deliveries.size());
  for (const Canvas::TileDeliveries& tile : canvas.deliveries)
    all.tiles.push_back({tile.by, std::accumulate(tile.taken.begin(), tile.taken.end(), FarmTime{}),
                         canvas.film->passes_of(static_cast<std::uint32_t>(all.tiles.size()))});
  for (const NameId name : canvas.deliverers)
    all.names.push_back(state_->names[static_cast<std::size_t>(name)]);
  return all;
}

std::vector<AssetData> Farm::assets(JobId id, std::optional<std::uint32_t> number) const {
  const JobFrame* frame = state_->frame(id, number);
  return frame ? frame->assets : std::vector<AssetData>{};
}

std::string Farm::script(JobId id) const {
  const auto job = state_->jobs.find(id);
  return job == state_->jobs.end() || has_ended(job->second) ? std::string() : job->second.spec.script;
}

SharedBytes Farm::scene(JobId id, std::optional<std::uint32_t> number) const {
  const JobFrame* frame = state_->frame(id, number);
  return frame ? frame->scene_bytes : nullptr;
}

std::uint64_t Farm::revision() const { return state_->revision; }

}  // namespace rayfarm
