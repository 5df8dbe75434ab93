// Phong's reflectance model with Schlick's factor, as the course's renderer defines it.
// Sources: B. T. Phong, CACM 18(6), 1975; C. Schlick, An Inexpensive BRDF Model, CGF 13(3), 1994.
//
// Directions are unit and point away from the surface; n points out of the material.
#pragma once
#include <optional>

#include "common/math/vec.h"
#include "common/scene/scene.h"

namespace rayfarm {

struct PhongWeights {
  double diffuse, specular, transmission;
};

/// The weights for light from a direction with cosine `a` to the normal. From inside (a <= 0) at an angle of
/// total reflection the transmission joins the highlight.
PhongWeights phong_weights(const Material& material, double index, double a, bool viewer_outside);

inline Vec3d mirrored(const Vec3d& d, const Vec3d& n) { return n * (2 * dot(n, d)) - d; }

/// The direction in which light that comes from `d` goes on through the surface; none at total reflection.
/// `index` of refraction: the material's over that of the other side.
std::optional<Vec3d> refracted(const Vec3d& d, const Vec3d& n, double index);

/// What a light of intensity 1 from `to_light` (outside, dot(n, to_light) > 0) sends to the viewer.
/// cos_view is dot(n, to_viewer), with the sign of the viewer's side.
Vec3d phong(const Material& material, double index, const Vec3d& color, const Vec3d& n,
            const Vec3d& to_viewer, double cos_view, const Vec3d& to_light);

/// The same for ambient light.
Vec3d phong_ambient(const Material& material, const Vec3d& color, bool viewer_outside);

}  // namespace rayfarm
