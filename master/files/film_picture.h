// A film as the picture that is written or sent of it.
#pragma once
#include <string>

#include "common/render/film.h"
#include "common/render/settings.h"
#include "master/files/image_file.h"

namespace rayfarm {

/// A complete film gives the picture that `rayfarm render` writes. Of another one the coarse pixels fill the
/// missing ones, and the header says how many are missing.
Picture film_picture(const Film& film, const std::string& scene_hash, const RenderSettings& settings);

}  // namespace rayfarm
