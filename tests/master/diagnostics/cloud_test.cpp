#include "master/diagnostics/cloud.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include "common/render/render.h"
#include "common/work/each_tile.h"
#include "master/diagnostics/collecting_render.h"
#include "master/files/image_file.h"
#include "tests/support/mirror_hall.h"
#include "tests/support/random_scene.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solid_definitions.h"

namespace rayfarm {
namespace {

const std::function<bool()> never = [] { return false; };

RenderSettings small() {
  RenderSettings s;
  s.width = 100, s.height = 70, s.spp = 4;
  return s;
}

/// Writes the cloud of the picture's rays by so many threads; returns its number of points.
std::uint64_t write_cloud(const std::filesystem::path& file, const World& world, const CloudOptions& options,
                          unsigned threads) {
  const RenderSettings s = small();
  CloudFile cloud(file, options);
  CollectingRender render(world, s, {});
  render.also_collect(cloud);
  EXPECT_TRUE(each_tile(
      {s.width, s.height}, threads,
      [&](std::uint32_t tile) { return render.render_tile(tile, all_passes, never).has_value(); }, [] {}));
  return cloud.commit();
}

/// Reads what our writer writes, by the header's words.
std::vector<PlyPoint> points_of(const std::string& bytes) {
  const std::string end = "end_header\n";
  const std::size_t body = bytes.find(end) + end.size();
  std::istringstream header(bytes.substr(0, body));
  std::string word;
  std::size_t count = 0;
  bool ascii = false, compact = false;
  while (header >> word) {
    if (word == "ascii") ascii = true;
    if (word == "nu") compact = true;
    if (word == "vertex") header >> count;
  }
  std::vector<PlyPoint> points(count);
  if (ascii) {
    std::istringstream text(bytes.substr(body));
    for (PlyPoint& p : points) {
      for (float& v : p.position) text >> v;
      for (float& v : p.normal) text >> v;
      for (std::uint8_t& v : p.color) {
        unsigned number = 0;
        text >> number;
        v = static_cast<std::uint8_t>(number);
      }
    }
    EXPECT_TRUE(text && (text >> word).eof());
    return points;
  }
  const char* at = bytes.data() + body;
  const auto take = [&](auto& value) { std::memcpy(&value, at, sizeof value), at += sizeof value; };
  EXPECT_EQ(bytes.size() - body, count * (compact ? 19 : 27));
  if (bytes.size() - body != count * (compact ? 19 : 27)) return {};
  for (PlyPoint& p : points) {
    take(p.position);
    if (compact) {
      Octahedral normal;
      take(normal);
      p.normal = unit_of(normal);
    } else {
      take(p.normal);
    }
    take(p.color);
  }
  return points;
}

TEST(Cloud, LiesOnTheScenesSurfacesWithUnitNormals) {
  const ScratchFolder folder;
  for (const std::uint64_t seed : {0, 1, 3, 4, 5, 6}) {  // what scene 2 has lies out of view
    const World world(random_scene(seed));
    const std::uint64_t count = write_cloud(folder / "a.ply", world, {}, 2);
    const std::vector<PlyPoint> points = points_of(content_of(folder / "a.ply"));
    EXPECT_EQ(points.size(), count);
    EXPECT_GT(count, 100u);
    for (std::size_t i = 0; i < points.size(); i += 5) {
      const PlyPoint& point = points[i];
      const Vec3d p{point.position[0], point.position[1], -point.position[2]};  // z is mirrored
      const Vec3d n{point.normal[0], point.normal[1], -point.normal[2]};
      ASSERT_NEAR(length(n), 1, 1e-6);
      double nearest = infinity;
      for (const Leaf& leaf : world.parts().leaves) {
        const Vec3d local{dot(leaf.row[0], p) + leaf.offset.x, dot(leaf.row[1], p) + leaf.offset.y,
                          dot(leaf.row[2], p) + leaf.offset.z};
        // The file's floats round the point by 6e-8 of its size, the leaf's transform stretches that.
        const double scale =
            (1 + max_abs(p)) * (length(leaf.row[0]) + length(leaf.row[1]) + length(leaf.row[2]));
        nearest = std::min(nearest, std::fabs(beyond(leaf.solid, local)) / scale);
      }
      ASSERT_LT(nearest, 1e-6) << "scene " << seed;
    }
  }
}

TEST(Cloud, HasAPointForEachRayThatHits) {
  const ScratchFolder folder;
  const World world(random_scene(4));
  RayCounters counters;
  for (const std::uint32_t tile : centre_first({small().width, small().height})) {
    const auto images = render_tile(world, small(), tile, all_passes, never);
    for (const PassImage& image : *images) counters += image.counters;
  }
  EXPECT_GT(counters.secondary_hits, 100u);
  EXPECT_EQ(write_cloud(folder / "a.ply", world, {}, 3), counters.primary_hits + counters.secondary_hits);
  EXPECT_EQ(write_cloud(folder / "a.ply", world, {.visible_only = true}, 3), counters.primary_hits);
}

TEST(Cloud, HasTheSameBytesForAnyNumberOfThreads) {
  const ScratchFolder folder;
  const World world(random_scene(4));
  for (const double voxel : {0.0, 0.05}) {
    write_cloud(folder / "one.ply", world, {.voxel = voxel}, 1);
    write_cloud(folder / "many.ply", world, {.voxel = voxel}, 7);
    EXPECT_EQ(content_of(folder / "one.ply"), content_of(folder / "many.ply"));
  }
}

TEST(Cloud, SaysTheSameInAllForms) {
  const ScratchFolder folder;
  const World world(random_scene(5));
  const auto read = [&](PlyForm form) {
    write_cloud(folder / "a.ply", world, {.form = form}, 2);
    return points_of(content_of(folder / "a.ply"));
  };
  const std::vector<PlyPoint> binary = read(PlyForm::binary), ascii = read(PlyForm::ascii),
                              compact = read(PlyForm::compact);
  ASSERT_EQ(ascii.size(), binary.size());
  ASSERT_EQ(compact.size(), binary.size());
  for (std::size_t i = 0; i < binary.size(); ++i) {
    ASSERT_EQ(ascii[i].position, binary[i].position);
    ASSERT_EQ(ascii[i].normal, binary[i].normal);
    ASSERT_EQ(ascii[i].color, binary[i].color);
    ASSERT_EQ(compact[i].position, binary[i].position);
    ASSERT_EQ(compact[i].color, binary[i].color);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(compact[i].normal[c], binary[i].normal[c], 7e-5);
  }
}

TEST(Cloud, ThinnedHasOnePointInEachVoxelThatHasAny) {
  const ScratchFolder folder;
  const World world(random_scene(1));
  const double side = 0.1;
  using Cell = std::array<double, 3>;
  const auto cell_of = [&](const PlyPoint& p) {
    return Cell{std::floor(p.position[0] / side), std::floor(p.position[1] / side),
                std::floor(p.position[2] / side)};
  };
  std::set<Cell> all;
  write_cloud(folder / "all.ply", world, {}, 2);
  for (const PlyPoint& p : points_of(content_of(folder / "all.ply"))) all.insert(cell_of(p));
  const std::uint64_t count = write_cloud(folder / "thin.ply", world, {.voxel = side}, 2);
  std::set<Cell> kept;
  for (const PlyPoint& p : points_of(content_of(folder / "thin.ply"))) kept.insert(cell_of(p));
  EXPECT_EQ(kept, all);
  EXPECT_EQ(kept.size(), count);
}

TEST(Cloud, AFullDiskIsAnErrorForAllThreadsAndKeepsTheOldFile) {
  const ScratchFolder folder;
  put_content(folder / "a.ply", "old");
  const World world(random_scene(4));
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const rlimit full{100'000, old.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THROW(write_cloud(folder / "a.ply", world, {}, 4), FileError);
  ::setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_EQ(content_of(folder / "a.ply"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(SmallCloud, HasAsManyPointsAsAskedForEvenlyOverThePicture) {
  Scene scene;  // a wall before the camera fills the picture
  scene.nodes = {{Cube{}, Affine{glm::dmat3(100.0), {-50, -50, 5}}, {}, {}, {}, {}}};
  scene.camera = PerspectiveCamera{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90};
  const World world(scene);
  const auto bytes = small_cloud(world, small(), {.visible_only = true}, 4096, never, [](double) {});
  ASSERT_TRUE(bytes);
  const std::vector<PlyPoint> points = points_of({bytes->begin(), bytes->end()});
  ASSERT_EQ(points.size(), 4096u);
  // The wall seen is 10 wide and 7 high: 16 x 16 parts of it have 16 points each, give or take rounding.
  std::array<int, 256> parts{};
  for (const PlyPoint& p : points) {
    const double u = (p.position[0] + 5) / 10 * 16, v = (p.position[1] + 3.5) / 7 * 16;
    ++parts[static_cast<std::size_t>(std::clamp(v, 0.0, 15.0)) * 16 +
            static_cast<std::size_t>(std::clamp(u, 0.0, 15.0))];
  }
  for (const int count : parts) EXPECT_NEAR(count, 16, 4);
  EXPECT_FALSE(small_cloud(
      world, small(), {}, 4096, [] { return true; }, [](double) {}));
}

TEST(SmallCloud, EndsWhereThereIsNothingToMeet) {
  Scene scene;
  scene.nodes = {{Sphere{}, Affine{glm::dmat3(1.0), {0, 0, -10}}, {}, {}, {}, {}}};  // behind the camera
  scene.camera = PerspectiveCamera{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 60};
  const auto bytes = small_cloud(World(scene), small(), {}, 1000, never, [](double) {});
  ASSERT_TRUE(bytes);
  EXPECT_TRUE(points_of({bytes->begin(), bytes->end()}).empty());
}

TEST(SmallCloud, StopsInTheMiddleOfARaysTree) {
  RenderSettings settings = small();
  settings.max_depth = 90, settings.min_importance = 0;
  int questions = 0;
  EXPECT_FALSE(small_cloud(
      World(mirror_hall()), settings, {}, 1000, [&] { return ++questions == 2; }, [](double) {}));
  EXPECT_EQ(questions, 2);
}

}  // namespace
}  // namespace rayfarm
