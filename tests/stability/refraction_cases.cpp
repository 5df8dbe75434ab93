// S20: refraction through several media: parallel plates, concentric spheres, the critical angle, from outside
// and from within. Ground truth in closed form; the original's rule, air on the other side of every surface, is
// ours without nested media.
#include "common/render/hit.h"
#include "common/render/shade.h"
#include "tests/stability/cases.h"
#include "tests/stability/quad.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

constexpr double eps = 2 * unit_roundoff;

/// Node number i of a union gets material number i.
Scene scene_of_media(std::vector<Node> parts, const std::vector<double>& indices, bool nested) {
  Scene scene = scene_of({operation_node(CsgOp::unite, static_cast<std::uint32_t>(parts.size()))});
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    parts[i].material = i;
    scene.nodes.push_back(parts[i]);
    scene.materials.emplace_back().index = indices[i];
  }
  scene.nested_media = nested;
  return scene;
}

/// A ray on its way through surfaces.
class Traveller {
 public:
  Traveller(const World& world, const Ray& ray) : world_(world), ray_(ray) {}

  /// Goes on to the next surface. False when there is none.
  bool meet() {
    const RayQuery query(ray_);
    const auto boundary = first_boundary(world_.parts(), query, workspace_);
    if (!boundary) return false;
    hit_ = hit_at(world_.parts(), query, *boundary);
    is_lost_ = is_lost_ || contradicts(ray_, hit_);
    return true;
  }
  /// Goes through it. False at total reflection.
  bool pass() {
    const auto bent = refracted(-ray_.direction, hit_.normal, hit_.index);
    if (bent) ray_ = ray_from(hit_, *bent, !hit_.entering);
    return bent.has_value();
  }

  const Ray& ray() const { return ray_; }
  const Hit& hit() const { return hit_; }
  bool is_lost() const { return is_lost_; }

 private:
  const World& world_;
  Ray ray_;
  Hit hit_;
  bool is_lost_ = false;
  WorldWorkspace workspace_;
};

/// Plates face to face across z, one after another, each of another index up to the driver's.
RunBatch through_plates(bool nested) {
  return [nested](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto plates = static_cast<std::size_t>(random.uniform(1, 20));
    const auto chains = twin_chains(random);
    std::vector<Node> parts;
    std::vector<double> indices;
    for (std::size_t i = 0; i < plates; ++i) {
      const Affine slab = translation({-1e3, -1e3, double(i)}) * scaling({2e3, 2e3, 1});
      parts.push_back(solid_node(Cube{}, chains[i % 2] * slab));
      indices.push_back(random.uniform(1, batch.driver));
    }
    const World world(scene_of_media(parts, indices, nested));
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      // At most 60 degrees from the plates' normal.
      const double slope = random.uniform(0, 1.7), turn = random.uniform(-3.14, 3.14);
      const Vec3d down = normalized(Vec3d{slope * std::cos(turn), slope * std::sin(turn), 1});
      Ray ray;
      ray.origin = moved(chains[0], down * (-1 / down.z));
      ray.direction = normalized(moved(chains[0], down * (1 / down.z)) - ray.origin);
      Traveller traveller(world, ray);
      std::size_t passed = 0;
      while (traveller.meet() && traveller.pass()) ++passed;
      const double turned = max_abs(traveller.ray().direction - ray.direction);
      tally.failures +=
          traveller.is_lost() || passed != plates + 1 || turned > 16 * eps * static_cast<double>(plates + 1);
    }
    return tally;
  };
}

/// Spheres about one centre, the inner ones written later. A ray keeps n * (distance of its line from the
/// centre): Bouguer's law. It goes in, past its nearest point to the centre, and out again, or is reflected
/// where the law says so.
RunBatch through_spheres(bool from_within) {
  return [from_within](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto shells = static_cast<std::size_t>(batch.driver);
    const Vec3d c = random.in_box(3);
    std::vector<Node> parts;
    std::vector<double> indices, radii;
    for (std::size_t i = 0; i < shells; ++i) {
      radii.push_back(1 - 0.9 * static_cast<double>(i) / static_cast<double>(shells));
      parts.push_back(solid_node(Sphere{}, translation({c.x, c.y, c.z}) * scaling(glm::dvec3(radii[i]))));
      indices.push_back(random.uniform(1, 2));
    }
    const World world(scene_of_media(parts, indices, true));
    const auto index_of = [&](std::uint32_t medium) { return medium == empty_space ? 1 : indices[medium]; };
    const auto lever = [&](const Ray& ray) {
      return length(cross(quad(ray.origin - c), quad(ray.direction)));
    };
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      Ray ray = ray_towards(c + random.in_box(0.5), 5, random);
      std::uint32_t medium = empty_space;
      if (from_within) {
        const auto shell = static_cast<std::size_t>(random.uniform(0, batch.driver));
        const double inside = shell + 1 < shells ? radii[shell + 1] : 0;
        ray.origin = c + random.direction() * (inside + random.uniform(0.1, 0.9) * (radii[shell] - inside));
        medium = static_cast<std::uint32_t>(shell);
      }
      const Quad invariant = index_of(medium) * lever(ray);
      Traveller traveller(world, ray);
      bool is_wrong = false;
      std::size_t passed = 0;
      for (; !is_wrong && traveller.meet() && passed <= 2 * shells; ++passed) {
        const Hit& hit = traveller.hit();
        is_wrong = traveller.is_lost() || (hit.entering ? hit.outer : hit.inner) != medium;
        medium = hit.entering ? hit.inner : hit.outer;
        if (is_wrong) break;
        // Total reflection exactly when the sine of the angle beyond would exceed 1.
        const Quad sine = invariant / (index_of(medium) * length(quad(hit.point - c)));
        if (!traveller.pass()) {
          is_wrong = sine < 1 - 1e-12;
          break;
        }
        const Quad error = fabs(index_of(medium) * lever(traveller.ray()) - invariant);
        is_wrong = sine > 1 + 1e-12 || error > 16 * eps * Quad(passed + 1);
      }
      tally.failures += is_wrong;
    }
    return tally;
  };
}

/// From inside a plate of glass at its face: total reflection at angles whose sine is above 1 / index by the
/// driver (relative), none below.
Tally at_critical_angle(const Batch& batch) {
  RandomRays random(batch.seed);
  const auto chains = twin_chains(random);
  const double index = random.uniform(1.1, 4);
  const World world(scene_of_media({solid_node(Cube{}, chains[0])}, {index}, true));
  const QuadAffine local_from_world = inverse(quad(chains[0]));
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const double sign = random.uniform(0, 1) < 0.5 ? -1 : 1;
    const double sine = (1 + sign * batch.driver) / index, cosine = std::sqrt(1 - sine * sine);
    Ray ray;
    ray.origin = moved(chains[0], {0.5, 0.5, 0.9});
    const Vec3d down = Vec3d{0.3 * sine, 0, 0.3 * cosine};
    ray.direction = moved(chains[0], Vec3d{0.5, 0.5, 0.9} + down) - ray.origin;
    ray.direction = normalized(ray.direction);
    // The exact sine of the ray as it was rounded.
    const QuadVec d = unit(direction(local_from_world, quad(ray.direction)));
    const Quad excess = index * sqrtq(d.x * d.x + d.y * d.y) - 1;
    Traveller traveller(world, ray);
    const bool is_wrong = !traveller.meet() || traveller.pass() == (excess > 0);
    tally.failures += is_wrong && fabs(excess) > batch.driver / 2;
  }
  return tally;
}

/// Into a ball of one material and out of it there is no total reflection.
Tally through_ball(const Batch& batch) {
  RandomRays random(batch.seed);
  const auto chains = twin_chains(random);
  const World world(scene_of_media({solid_node(Sphere{}, chains[0])}, {random.uniform(1.01, 4)}, true));
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const Vec3d from = random.direction(), across = normalized(cross(from, random.direction()));
    Ray ray;
    ray.origin = moved(chains[0], across * (1 - batch.driver) + from * 5.0);
    ray.direction = normalized(moved(chains[0], across * (1 - batch.driver)) - ray.origin);
    Traveller traveller(world, ray);
    tally.failures += !(traveller.meet() && traveller.pass() && traveller.meet() && traveller.pass()) ||
                      traveller.meet() || traveller.is_lost();
  }
  return tally;
}

}  // namespace

std::vector<Case> refraction_cases() {
  const CellSize small{50'000, 10'000'000, 500};
  const std::vector<double> shells{1, 2, 3, 5, 10};
  return {
      {"S20 plates",
       "wrong direction or count after 1-20 plates",
       "largest index of refraction",
       {1.1, 1.5, 2, 3, 4},
       {{"air outside", "double", through_plates(false), {}}, {"ours", "double", through_plates(true), 0.0}},
       small},
      {"S20 spheres",
       "Bouguer's law broken in concentric spheres",
       "spheres",
       shells,
       {{"ours", "double", through_spheres(false), 0.0}},
       small},
      {"S20 camera inside",
       "the same from within",
       "spheres",
       shells,
       {{"ours", "double", through_spheres(true), 0.0}},
       small},
      {"S20 critical angle",
       "total reflection on the wrong side of it",
       "distance of the sine from critical, relative",
       {1e-12, 1e-10, 1e-8, 1e-4, 1e-2},
       {{"ours", "double", at_critical_angle, 0.0}},
       small},
      {"S20 ball",
       "total reflection in a homogeneous ball",
       "distance from grazing / radius",
       {1e-12, 1e-8, 1e-4, 1e-2, 0.5},
       {{"ours", "double", through_ball, 0.0}},
       small}};
}

}  // namespace rayfarm::stability
