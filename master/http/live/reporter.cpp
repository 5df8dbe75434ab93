#include "master/http/live/reporter.h"

#include <nlohmann/json.hpp>
#include <set>

#include "master/http/api_error.h"
#include "master/http/farm_json.h"
#include "master/http/live/job_layer.h"
#include "master/http/live/json.h"
#include "master/http/live/picture_layer.h"
#include "master/http/worker_list.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr std::uint32_t tiles_at_once = 64;  // 3 MB: a millisecond of the farm's thread
constexpr auto time_for_a_layer = std::chrono::milliseconds(50);
constexpr double state_bytes_per_second = 1e6;

/// A layer that there is not is shown as failed.
LayerSource no_layer(const std::string& words) {
  return [words](const auto&, std::uint32_t) -> LayerNews { throw ApiError(404, words); };
}

LayerSource source_of(const Doors& doors, const LayerName& name) {
  if (name.layer == "picture") return picture_layer(doors.farm, name.job, name.frame);
  const MapKind* kind = map_named(name.layer);
  const std::optional<Reduction> reduction = reduction_named(name.reduce);
  if (!kind) return no_layer("there is no map " + name.layer);
  if (!reduction) return no_layer("maps are not reduced to " + name.reduce);
  return map_layer(doors.farm, doors.diagnostics, name.job, name.frame, {kind, *reduction, name.compat});
}

struct FarmNow {
  std::uint64_t revision = 0;
  FarmTime now{};
  std::vector<JobView> jobs;  // when the state shall be told
  WorkerList workers;
  std::vector<LogLine> lines;
};

}  // namespace

LiveNews LiveReporter::look_up(const LiveWish& wish) {
  LiveNews news;
  std::set<std::uint32_t> wanted;
  for (const LiveWish::Layer& layer : wish.layers) wanted.insert(layer.id);
  std::erase_if(pollers_, [&](const auto& poller) { return !wanted.contains(poller.first); });
  try {
    look_at_farm(wish, news);
    for (const LiveWish::Layer& layer : wish.layers) news.layers.push_back({layer.id, poll(layer)});
  } catch (const FarmUnavailable&) {  // it may be there the next time
  }
  return news;
}

void LiveReporter::look_at_farm(const LiveWish& wish, LiveNews& news) {
  FarmNow found = doors_.farm.ask([wish, due = next_state_, doors = &doors_](Farm& farm, FarmTime now) {
    FarmNow found{farm.revision(), now, {}, {}, doors->master.log(wish.log_after)};
    if (!wish.state_is_missing && now < due) return found;
    found.workers = worker_list(farm, doors->master);
    found.jobs = farm.jobs(now);
    return found;
  });
  news.now = found.now;
  news.lines = std::move(found.lines);
  if (!wish.state_is_missing && found.now < next_state_) return;

  const std::string workers = to_json(found.workers, FarmTime{})
                                  .dump(-1, ' ', false, json::error_handler_t::replace);  // ages stand still
  if (!wish.state_is_missing && found.revision == revision_ && workers == workers_) return;
  json jobs = json::array();
  for (const JobView& job : found.jobs) jobs.push_back(to_json(job, found.now));
  news.state = text_message({{"type", "state"},
                             {"revision", found.revision},
                             {"jobs", std::move(jobs)},
                             {"workers", to_json(found.workers, found.now)}});
  revision_ = found.revision;
  workers_ = workers;
  const std::chrono::duration<double> pause(static_cast<double>(news.state->size()) / state_bytes_per_second);
  next_state_ = found.now + std::chrono::duration_cast<FarmTime>(pause);
}

FeedNews LiveReporter::poll(const LiveWish::Layer& layer) {
  auto poller = pollers_.find(layer.id);
  if (poller == pollers_.end())
    poller = pollers_.emplace(layer.id, LayerPoller(layer.id, source_of(doors_, layer.name))).first;
  const auto end = std::chrono::steady_clock::now() + time_for_a_layer;
  FeedNews all = poller->second.poll(tiles_at_once);
  while (!all.is_all && std::chrono::steady_clock::now() < end) {
    FeedNews more = poller->second.poll(tiles_at_once);
    if (more.state) all.state = std::move(more.state);
    all.is_all = more.is_all;
    std::ranges::move(more.tiles, std::back_inserter(all.tiles));
  }
  return all;
}

}  // namespace rayfarm
