// Which bits this build of the renderer makes.
#pragma once
#include <string>

namespace rayfarm {

/// SHA-256, hexadecimal, of the pixels and ray counts of small renders that go through each kind of solid, surface,
/// camera, light and sampler. Builds that share it may share a picture; those that do not would leave seams in it.
/// Rendered at the first call, in some 30 ms.
const std::string& engine_fingerprint();

}  // namespace rayfarm
