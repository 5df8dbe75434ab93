// The light that rays gain from glow shells on their way. A shell is no surface: it changes no ray, so there is
// nothing to leave and nothing to start again behind it.
#pragma once
#include <optional>

#include "common/render/hit.h"

namespace rayfarm {

/// What the ray gains where it comes in through the shell before it meets `hit`; none if it does not. A shell on a
/// surface glows for rays that come to that surface, not for those that start there.
std::optional<Vec3d> glow_along(const GlowShell& shell, const RayQuery& ray, const std::optional<Hit>& hit);

}  // namespace rayfarm
