// What being right costs: the rays of a real render answered by ours and by a plain intersector, one after the other in
// one run. Prints a table; CPU time of this thread, medians.
//
// An answer is what a ray hits first, its point and normal there; of a shadow ray, whether something is in the way.
// In instructions, where no counters are at hand:
//
//   valgrind --tool=callgrind --callgrind-out-file=cost.out rayfarm_bench_cost sphere_flake
//   callgrind_annotate --inclusive=yes cost.out | grep answers_
#include <time.h>

#include <array>
#include <cstdio>

#include "common/render/render.h"
#include "common/render/render_passes.h"
#include "master/script/script.h"
#include "tests/benchmark/plain_intersector.h"

namespace rayfarm::benchmarks {
namespace {

struct Query {
  Ray ray;
  bool is_shadow;
};

struct RecordingObserver : CountingObserver {
  std::vector<Query>* queries = nullptr;

  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    CountingObserver::traced(kind, ray, depth, importance, hit);
    queries->push_back({ray, false});
  }
  void shadow_tested(const Ray& ray, bool blocked) {
    CountingObserver::shadow_tested(ray, blocked);
    queries->push_back({ray, true});
  }
};

const std::function<bool()> never = [] { return false; };

/// In the order in which the renderer asks them.
std::vector<Query> queries_of(const World& world, const RenderSettings& settings) {
  std::vector<Query> queries;
  RecordingObserver observer;
  observer.queries = &queries;
  Tracer<RecordingObserver> tracer(world, settings, observer);
  for (std::uint32_t tile = 0; tile < tile_count({settings.width, settings.height}); ++tile)
    render_passes(tracer, settings, tile_at({settings.width, settings.height}, tile), all_passes, never);
  return queries;
}

void render(const World& world, const RenderSettings& settings) {
  for (std::uint32_t tile = 0; tile < tile_count({settings.width, settings.height}); ++tile)
    render_tile(world, settings, tile, all_passes, never);
}

/// Where a ray hits, as t; infinity where it does not. Of a shadow ray 1 or 0. The points and normals are added up, so
/// that nobody can leave them out.
struct Answers {
  std::vector<double> what;
  Vec3d sum{};
};

[[gnu::noinline]] void answers_of_ours(const World::Parts& world, std::span<const Query> queries,
                                       Answers& answers) {
  WorldWorkspace workspace;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const RayQuery query(queries[i].ray);
    if (queries[i].is_shadow) {
      answers.what[i] = is_blocked(world, query, workspace);
      continue;
    }
    const std::optional<Boundary> b = first_boundary(world, query, workspace);
    answers.what[i] = b ? b->t : infinity;
    if (!b) continue;
    const Leaf& leaf = world.leaves[b->leaf];
    const SurfacePoint at = surface_at(leaf, to_local(leaf, query), b->t, b->leaf_entering);
    answers.sum += to_world(world.placements[b->leaf], at.point).point + normal_to_world(leaf, at.normal);
  }
}

[[gnu::noinline]] void answers_of_plain(PlainIntersector& plain, std::span<const Query> queries,
                                        Answers& answers) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const RayQuery query(queries[i].ray);
    if (queries[i].is_shadow) {
      answers.what[i] = plain.is_blocked(query);
      continue;
    }
    const std::optional<PlainHit> hit = plain.first_hit(query);
    answers.what[i] = hit ? hit->t : infinity;
    if (hit) answers.sum += hit->point + hit->normal;
  }
}

/// How many are not the same but for rounding.
std::size_t count_others(std::span<const double> a, std::span<const double> b) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    others += a[i] != b[i] && !(std::fabs(a[i] - b[i]) <= 1e-9 * a[i]);
  return others;
}

double cpu_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work>
double seconds_of(Work work) {
  const double before = cpu_seconds();
  work();
  return cpu_seconds() - before;
}

constexpr std::size_t rounds = 9;
double median(std::array<double, rounds> values) {
  std::sort(values.begin(), values.end());
  return values[rounds / 2];
}

void measure(const std::string& scene) {
  const World world(evaluate_file(RAYFARM_SOURCE_DIR "/scenes/" + scene + ".lua", {}, 0).scene);
  const RenderSettings settings{.width = 320, .height = 180, .spp = 1};
  const std::vector<Query> queries = queries_of(world, settings);
  PlainIntersector plain(world.parts());

  Answers ours{std::vector<double>(queries.size())}, theirs = ours;
  std::array<double, rounds> our_time, plain_time, ratio, render_time;
  for (std::size_t i = 0; i < rounds; ++i) {
    our_time[i] = seconds_of([&] { answers_of_ours(world.parts(), queries, ours); });
    plain_time[i] = seconds_of([&] { answers_of_plain(plain, queries, theirs); });
    render_time[i] = seconds_of([&] { render(world, settings); });
    ratio[i] = our_time[i] / plain_time[i];
  }
  const double count = static_cast<double>(queries.size()), rendered = median(render_time);
  const double ours_all = median(our_time), plain_all = median(plain_time);
  std::printf("%-21s %8zu %8.1f %8.1f %7.2f %8.2f %13.0f\n", scene.c_str(), queries.size(),
              ours_all / count * 1e9, plain_all / count * 1e9, median(ratio),
              rendered / (rendered - ours_all + plain_all),
              static_cast<double>(count_others(ours.what, theirs.what)) / count * 1e6);
}

}  // namespace
}  // namespace rayfarm::benchmarks

int main(int argc, char** argv) {
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) scenes = {"sphere_plane", "hedgehog_in_the_cage", "circus", "sphere_flake"};
  std::printf("scene                  queries  ns ours    plain   ratio   render  other answers\n");
  std::printf("                                  /query   /query           ratio  in a million\n");
  for (const std::string& scene : scenes) rayfarm::benchmarks::measure(scene);
}
