// Where the cameras' rays go.
#include "common/render/camera_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace rayfarm {
namespace {

constexpr double pi = 3.14159265358979323846;
const glm::dvec3 from{1, 2, 3}, direction{0.5, -0.25, 2}, up{0.1, 1, 0};
constexpr Size wide{320, 200}, tall{100, 260}, square{64, 64};

std::vector<Camera> all_cameras() {
  return {PerspectiveCamera{from, direction, up, 70}, FisheyeCamera{from, direction, up, 360},
          FisheyeCamera{from, direction, up, 120}, ParabolicCamera{from, direction, up, 1.5, 0.25},
          OrthographicCamera{from, direction, up, 7}};
}

/// Calls visit(x, y) all over the film, its edges included.
void all_over(Size film, const std::function<void(double, double)>& visit) {
  for (double y = 0; y <= film.height; y += film.height / 16.0)
    for (double x = 0; x <= film.width; x += film.width / 16.0) visit(x, y);
}

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / pi;
}

/// From the film's middle, 1 at the nearer edges.
double disc_radius(Size film, double x, double y) {
  return std::hypot(x - film.width / 2.0, y - film.height / 2.0) / (std::min(film.width, film.height) / 2.0);
}

TEST(CameraRays, AreUnitAndGoRightAndUpAsTheFilmDoes) {
  for (const Camera& camera : all_cameras())
    for (const Size film : {wide, tall, square}) {
      const CameraRays rays(camera, film);
      const CameraAxes& axes = rays.axes();
      EXPECT_NEAR(dot(axes.right, axes.up), 0, 1e-15);
      EXPECT_NEAR(dot(axes.forward, vec(direction)), length(vec(direction)), 1e-15);
      EXPECT_GT(dot(axes.up, vec(up)), 0);
      EXPECT_NEAR(length(cross(axes.up, axes.forward) - axes.right), 0, 1e-15) << "the view is left-handed";
      all_over(film, [&](double x, double y) {
        const std::optional<Ray> ray = rays.ray(x, y);
        if (!ray) return;
        EXPECT_NEAR(length(ray->direction), 1, 4e-16);
        // A little ahead of its origin the ray lies on that side of the axis on which it is on the film; a fisheye's
        // that looks straight back lies on it.
        const Vec3d ahead = ray->origin + ray->direction - rays.from();
        const double right = dot(ahead, axes.right), above = dot(ahead, axes.up);
        const double film_right = x - film.width / 2.0, film_up = film.height / 2.0 - y;
        EXPECT_GE(right * film_right, -1e-13) << x << "," << y;
        EXPECT_GE(above * film_up, -1e-13) << x << "," << y;
      });
    }
}

TEST(CameraRays, OfAPerspectiveCameraSpanTheHorizontalAngle) {
  for (const Size film : {wide, tall}) {
    const CameraRays rays(PerspectiveCamera{from, direction, up, 70}, film);
    const double y = film.height / 2.0;
    EXPECT_NEAR(degrees_between(rays.ray(0, y)->direction, rays.ray(film.width, y)->direction), 70, 1e-12);
    EXPECT_EQ(rays.ray(7, 9)->origin, vec(from));
  }
}

TEST(CameraRays, OfAFisheyeTurnEvenlyWithTheDistanceFromTheMiddle) {
  for (const double angle : {360.0, 180.0, 10.0})
    for (const Size film : {wide, tall, square}) {
      const CameraRays rays(FisheyeCamera{from, direction, up, angle}, film);
      all_over(film, [&](double x, double y) {
        const double r = disc_radius(film, x, y);
        const std::optional<Ray> ray = rays.ray(x, y);
        ASSERT_EQ(ray.has_value(), r <= 1) << x << "," << y;
        if (!ray) return;
        EXPECT_NEAR(degrees_between(ray->direction, rays.axes().forward), r * angle / 2, 1e-6);
        EXPECT_EQ(ray->origin, vec(from));
      });
      EXPECT_EQ(rays.ray(film.width / 2.0, film.height / 2.0)->direction, rays.axes().forward);
    }
}

TEST(CameraRays, OfAParabolicCameraAreThoseThatAMirrorSendsAlongItsAxis) {
  for (const double radius : {1.0, 0.3, 3.0})
    for (const double size : {0.0, 0.75}) {
      const CameraRays rays(ParabolicCamera{from, direction, up, radius, size}, wide);
      const CameraAxes& axes = rays.axes();
      all_over(wide, [&](double x, double y) {
        const double r = radius * disc_radius(wide, x, y);
        const std::optional<Ray> ray = rays.ray(x, y);
        ASSERT_EQ(ray.has_value(), r <= radius);
        if (!ray) return;
        EXPECT_NEAR(degrees_between(ray->direction, axes.forward), 2 * std::atan(r) * 180 / pi, 1e-6);
        const Vec3d place = ray->origin - vec(from);
        EXPECT_NEAR(dot(place, axes.forward), size * (1 - r * r) / 2, 1e-14);
        EXPECT_NEAR(length(cross(place, ray->direction)), 0, 1e-14) << "from the mirror's focus";
        if (size == 0) return;
        // The mirror's normal (u, v, 1) halves the angle between the ray and the axis.
        const Vec3d across = place - axes.forward * dot(place, axes.forward);
        const Vec3d normal = normalized(across * (1 / size) + axes.forward);
        EXPECT_NEAR(degrees_between(normal, axes.forward), degrees_between(normal, ray->direction), 1e-6);
      });
    }
}

TEST(CameraRays, OfAnOrthographicCameraAreParallelAndAsFarApartAsThePixels) {
  for (const Size film : {wide, tall}) {
    const CameraRays rays(OrthographicCamera{from, direction, up, 7}, film);
    const CameraAxes& axes = rays.axes();
    all_over(film, [&](double x, double y) {
      const std::optional<Ray> ray = rays.ray(x, y);
      EXPECT_EQ(ray->direction, normalized(axes.forward));
      const Vec3d place = ray->origin - vec(from);
      EXPECT_NEAR(dot(place, axes.right), 7 * (x / film.width - 0.5), 1e-14);
      EXPECT_NEAR(dot(place, axes.up), 7 * (0.5 * film.height - y) / film.width, 1e-14);
      EXPECT_NEAR(dot(place, axes.forward), 0, 1e-14);
    });
  }
}

}  // namespace
}  // namespace rayfarm
