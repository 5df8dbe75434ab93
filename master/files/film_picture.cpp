#include "master/files/film_picture.h"

#include "master/files/picture_facts.h"

namespace rayfarm {

Picture film_picture(const Film& film, const std::string& scene_hash, const RenderSettings& settings) {
  Picture picture{film.size(), film.filled(), facts_of(scene_hash, settings)};
  if (film.is_complete()) return picture;
  const std::uint64_t pixels = std::uint64_t{film.size().width} * film.size().height;
  picture.facts["rayfarm:missing_pixels"] = std::to_string(pixels - film.pixels_done());
  return picture;
}

}  // namespace rayfarm
