#include "tests/reference/reference_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rayfarm {
namespace reference {
namespace {

constexpr Real pi = std::numbers::pi_v<Real>;

struct Tracer {
  const Scene& scene;
  const Rules& rules;
  const std::vector<Leaf>& leaves;
  const std::vector<PlacedGlow>& glows;
  const ReferenceSettings& settings;
};

struct Shaded {
  Vec point{0}, normal{0}, color{0};
  Material material;
};

Vec unit(const Vec& v) { return v / std::sqrt(glm::dot(v, v)); }

// Meeting the scene.
// -------------------------------------------------------------------------------------------

// Right, up, forward; the view is left-handed.
struct Axes {
  Vec right, up, forward;
};

template <class Camera>
Axes axes_of(const Camera& camera) {
  const Vec d = unit(Vec(camera.direction)), left = unit(glm::cross(d, Vec(camera.up)));
  return {-left, unit(glm::cross(left, d)), d};
}

// The film's middle is (0, 0), its nearer edges are 1 away from there.
using DiscPoint = glm::vec<2, Real, glm::defaultp>;

DiscPoint disc_point(const ReferenceSettings& film, Real x, Real y) {
  return DiscPoint(x - film.width / 2, film.height / 2 - y) * (2 / Real(std::min(film.width, film.height)));
}

using CameraRay = std::optional<Ray>;

CameraRay camera_ray(const PerspectiveCamera& camera, const ReferenceSettings& film, Real x, Real y) {
  const Axes axes = axes_of(camera);
  const Real half_width = std::tan(camera.angle_deg * pi / 360),
             half_height = half_width * film.height / film.width;
  return Ray{Vec(camera.from),
             unit(axes.forward + axes.up * (half_height - 2 * half_height * y / film.height) -
                  axes.right * (half_width - 2 * half_width * x / film.width))};
}

CameraRay camera_ray(const FisheyeCamera& camera, const ReferenceSettings& film, Real x, Real y) {
  const DiscPoint n = disc_point(film, x, y);
  const Real r = std::hypot(n.x, n.y), phi = std::atan2(n.y, n.x);
  if (r > 1) return std::nullopt;
  const Real theta = r * camera.angle_deg * pi / 360;
  const Axes axes = axes_of(camera);
  return Ray{Vec(camera.from), std::sin(theta) * std::cos(phi) * axes.right +
                                   std::sin(theta) * std::sin(phi) * axes.up +
                                   std::cos(theta) * axes.forward};
}

CameraRay camera_ray(const ParabolicCamera& camera, const ReferenceSettings& film, Real x, Real y) {
  const DiscPoint n = disc_point(film, x, y);
  if (std::hypot(n.x, n.y) > 1) return std::nullopt;
  const Real u = n.x * camera.radius, v = n.y * camera.radius, r2 = u * u + v * v;
  const Axes axes = axes_of(camera);
  const Vec origin =
      Vec(camera.from) + Real(camera.size) * (u * axes.right + v * axes.up + (1 - r2) / 2 * axes.forward);
  return Ray{origin, (2 * u * axes.right + 2 * v * axes.up + (1 - r2) * axes.forward) / (1 + r2)};
}

CameraRay camera_ray(const OrthographicCamera& camera, const ReferenceSettings& film, Real x, Real y) {
  const Axes axes = axes_of(camera);
  const Real pixel = camera.width / Real(film.width);
  return Ray{Vec(camera.from) + (x - Real(film.width) / 2) * pixel * axes.right +
                 (Real(film.height) / 2 - y) * pixel * axes.up,
             axes.forward};
}

std::optional<Crossing> first_crossing(const Spans& spans) {
  for (const Crossing& c : spans.crossings)
    if (c.t > 0) return c;
  return std::nullopt;
}

// The same for a ray that starts on a surface.
std::optional<Crossing> next_crossing(const Spans& spans, const Ray& ray, const Rules& rules) {
  for (const Crossing& c : spans.crossings)
    if (rules.is_ahead(c, ray)) return c;
  return std::nullopt;
}

// The crossing's own normal says which way the solid was passed; the operators may have turned that round.
Vec normal_of(const Crossing& c, const Ray& ray) {
  if (c.of_sheet) return c.normal;
  const bool front = glm::dot(c.normal, ray.direction) < 0;
  return c.entering == front ? c.normal : -c.normal;
}

// Textures. ---------------------------------------------------------------------------------------------------------

bool is_odd(Real u, Real v) { return std::fmod(std::floor(u) + std::floor(v), Real(2)) != 0; }

bool takes_color(const Checker& checker, Real u, Real v) { return is_odd(u * checker.fu, v * checker.fv); }
bool takes_color(const Stripes& stripes, Real u, Real v) {
  const Real fu = u * stripes.fu, fv = v * stripes.fv;
  return is_odd(fu, fv) == (fu - std::floor(fu) > fv - std::floor(fv));
}

Vec textured(const Texture& texture, const Uv& uv, const Vec& color) {
  if (std::holds_alternative<ImageTexture>(texture))
    throw std::invalid_argument("the reference tracer has no images");
  if (const auto* checker = std::get_if<Checker>(&texture))
    return takes_color(*checker, uv.x, uv.y) ? Vec(checker->color) : color;
  const Stripes& stripes = std::get<Stripes>(texture);
  return takes_color(stripes, uv.x, uv.y) ? Vec(stripes.color) : color;
}

Shaded shaded_at(const Leaf& leaf, const Crossing& c, const Ray& ray) {
  Shaded surface{ray.origin + (c.t + c.to_point) * ray.direction, normal_of(c, ray),
                 Vec(leaf.color.value_or(leaf.material.color)), leaf.material};
  const Vec local = leaf.local_from_world * (surface.point - leaf.offset);
  const Uv uv = leaf.surface ? c.uv : uv_of(leaf.solid, local, c.gradient);
  for (const Texture& texture : leaf.textures) surface.color = textured(texture, uv, surface.color);
  return surface;
}

// Light.
// -------------------------------------------------------------------------------------------------------

Vec mirrored(const Vec& v, const Vec& n) { return 2 * glm::dot(n, v) * n - v; }

// Both v and the result point away from the surface; none when all light is reflected.
std::optional<Vec> refracted(const Vec& v, Vec n, Real index) {
  Real d = glm::dot(n, v), ratio = 1 / index;
  if (d < 0) n = -n, d = -d, ratio = index;
  const Real c2 = 1 - ratio * ratio * (1 - d * d);
  if (c2 <= 0) return std::nullopt;
  return (ratio * d - std::sqrt(c2)) * n - ratio * v;
}

struct Weights {
  Real diffuse = 0, specular = 0, transmission = 0;
};

// Schlick's factor moves weight to the mirror at grazing angles; a is the cosine on the light's side.
Weights weights_of(const Material& m, Real a) {
  const Real w = m.schlick * std::pow(1 - std::abs(a), Real(5));
  return {m.diffuse * (1 - w), m.specular + w * (Real(m.diffuse) + m.transmission), m.transmission * (1 - w)};
}

// Inside, beyond the angle of total reflection, the mirror gets what would have passed.
void add_total_reflection(Weights& k, const Material& m, Real a) {
  const Real n = m.index, cos_total = n > 1 ? std::sqrt(n * n - 1) / n : 0;
  if (a > 0 || -a > cos_total) return;
  k.specular += k.transmission;
  if (k.specular + k.diffuse > 1) k.specular = 1 - k.diffuse;
}

// What comes from direction l (unit) and leaves in direction v.
Vec phong(const Shaded& s, const Vec& l, const Vec& v) {
  const Real a = glm::dot(l, s.normal);
  Weights k = weights_of(s.material, a);
  std::optional<Vec> main;
  Real passed = 1;
  if ((a > 0) == (glm::dot(v, s.normal) > 0)) {
    main = mirrored(l, s.normal);
    add_total_reflection(k, s.material, a);
  } else {
    main = refracted(l, s.normal, s.material.index);
    passed = k.transmission;
  }
  const Real cos_beta = main ? glm::dot(*main, v) : 0;
  const Real highlight = cos_beta > 0 ? k.specular * std::pow(cos_beta, Real(s.material.exponent)) : 0;
  return passed * (k.diffuse * std::abs(a) * s.color + highlight);
}

bool is_blocked(const Tracer& tracer, const Ray& to_light) {
  for (const Spans& spans : tracer.rules.blockers(tracer.scene, tracer.leaves, to_light, tracer.rules))
    for (const Crossing& c : spans.crossings)
      if (c.t < 1 && tracer.rules.is_ahead(c, to_light) && !tracer.leaves[c.leaf].no_shadow) return true;
  return false;
}

Vec from_point(const Tracer& tracer, const Shaded& s, const Vec& v, const Vec& at, const Vec& intensity) {
  const Ray to_light{s.point, at - s.point};
  if (glm::dot(to_light.direction, s.normal) <= 0) return Vec(0);
  if (tracer.settings.shadows && is_blocked(tracer, to_light)) return Vec(0);
  return intensity * phong(s, unit(to_light.direction), v);
}

Vec light_from(const Tracer&, const AmbientLight& light, const Shaded& s, const Vec& v) {
  const Real inside = glm::dot(v, s.normal) > 0 ? 1 : s.material.transmission;
  return Vec(light.intensity) * s.color * Real(s.material.ambient) * inside;
}
Vec light_from(const Tracer& tracer, const PointLight& light, const Shaded& s, const Vec& v) {
  return from_point(tracer, s, v, Vec(light.at), Vec(light.intensity));
}
Vec light_from(const Tracer& tracer, const RectangleLight& light, const Shaded& s, const Vec& v) {
  const Vec at = Vec(light.at) + Real(tracer.settings.light_uv.x) * Vec(light.width) +
                 Real(tracer.settings.light_uv.y) * Vec(light.height);
  const Real distance = std::sqrt(glm::dot(at - s.point, at - s.point));
  const Real dimming = light.dim[0] + light.dim[1] * distance + light.dim[2] * distance * distance;
  return from_point(tracer, s, v, at, Vec(light.intensity) / dimming);
}

Vec direct_light(const Tracer& tracer, const Shaded& s, const Vec& v) {
  if (tracer.scene.lights.empty()) return s.color;
  Vec sum(0);
  for (const Light& light : tracer.scene.lights)
    sum += std::visit([&](const auto& l) { return light_from(tracer, l, s, v); }, light);
  return sum;
}

// Recursion.
// ---------------------------------------------------------------------------------------------------

Vec radiance(const Tracer& tracer, const Ray& ray, int depth, Real importance);

Vec shade(const Tracer& tracer, const Shaded& s, const Vec& v, int depth, Real importance) {
  const ReferenceSettings& settings = tracer.settings;
  Vec color = direct_light(tracer, s, v);
  if (depth >= settings.max_depth) return color;

  const Real a = glm::dot(v, s.normal);
  Weights k = weights_of(s.material, a);
  add_total_reflection(k, s.material, a);
  if (settings.reflections && importance * k.specular >= settings.min_importance) {
    const Ray reflected{s.point, mirrored(v, s.normal)};
    color += k.specular * radiance(tracer, reflected, depth + 1, importance * k.specular);
  }

  const Real kt = s.material.transmission;
  if (!settings.refractions || importance * kt < settings.min_importance) return color;
  if (const auto through = refracted(v, s.normal, s.material.index))
    color += kt * radiance(tracer, {s.point, *through}, depth + 1, importance * kt);
  return color;
}

// What the shell adds to a ray that it meets before `hit`: the sine is that between ray and normal in its own space.
Vec glow_on(const PlacedGlow& placed, const Ray& ray, bool leaves_a_surface,
            const std::optional<Crossing>& hit) {
  const Leaf& leaf = placed.leaf;
  const Spans spans = spans_of(leaf, 0, ray);
  if (spans.crossings.empty()) return Vec(0);
  const Crossing& front = spans.crossings.front();
  if (front.t <= 0 || (leaves_a_surface && !is_ahead(front, ray))) return Vec(0);
  Crossing beyond = front;
  if (hit) beyond.t -= hit->t;
  if (hit && is_ahead(beyond, ray)) return Vec(0);
  Vec direction = leaf.local_from_world * ray.direction;
  const Vec point = leaf.local_from_world * (ray.origin + front.t * ray.direction - leaf.offset);
  if (const auto* tube = std::get_if<Cylinder>(&placed.glow.shape)) {
    if (point.z < tube->z_min || point.z > tube->z_max) return Vec(0);
    direction.z = 0;
  }
  const Vec side = glm::cross(unit(direction), unit(front.gradient));
  const Real sine = std::sqrt(glm::dot(side, side));
  return Vec(placed.glow.color) * std::pow(std::max(1 - sine, Real(0)), Real(placed.glow.exponent));
}

Vec radiance(const Tracer& tracer, const Ray& ray, int depth, Real importance) {
  const Spans spans = spans_of(tracer.scene, tracer.leaves, ray, tracer.rules);
  const auto hit = depth > 0 ? next_crossing(spans, ray, tracer.rules) : first_crossing(spans);
  Vec color(tracer.scene.background);
  if (hit)
    color = shade(tracer, shaded_at(tracer.leaves[hit->leaf], *hit, ray), -unit(ray.direction), depth,
                  importance);
  for (const PlacedGlow& glow : tracer.glows) color += glow_on(glow, ray, depth > 0, hit);
  return color;
}

std::optional<ReferenceHit> hit_of(const Spans& spans, const Ray& ray) {
  const auto c = first_crossing(spans);
  if (!c) return std::nullopt;
  return ReferenceHit{static_cast<double>(c->t),
                      glm::dvec3(ray.origin + (c->t + c->to_point) * ray.direction),
                      glm::dvec3(normal_of(*c, ray)), c->leaf};
}

}  // namespace
}  // namespace reference

ReferenceSample ReferenceTracer::sample(const ReferenceSettings& settings, double x, double y) const {
  using namespace reference;
  const Tracer tracer{scene_, rules_, leaves_, glows_, settings};
  const auto ray =
      std::visit([&](const auto& camera) { return camera_ray(camera, settings, x, y); }, scene_.camera);
  if (!ray) return {};
  return {hit_of(spans_of(scene_, leaves_, *ray, rules_), *ray), glm::dvec3(radiance(tracer, *ray, 0, 1))};
}

std::optional<ReferenceHit> ReferenceTracer::first_hit(const glm::dvec3& origin,
                                                       const glm::dvec3& direction) const {
  const reference::Ray ray{reference::Vec(origin), reference::Vec(direction)};
  return reference::hit_of(reference::spans_of(scene_, leaves_, ray, rules_), ray);
}

}  // namespace rayfarm
