#include "master/http/film_snapshot.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "master/http/api_error.h"
#include "master/http/job_subject.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t tiles_at_once = 256;  // 12 MB: some milliseconds

using Number = std::optional<std::uint32_t>;

std::shared_ptr<const Film> film_now(const Farm& farm, JobId id, Number frame, FarmTime now) {
  std::shared_ptr<const Film> film = film_so_far(farm, id, frame, now);
  if (!film) throw ApiError(409, "nothing of " + text_of(id, frame) + " is rendered yet");
  return film;
}

using TilePasses = std::vector<std::pair<std::uint32_t, PassImage>>;

TilePasses passes_there(const Film& film, std::uint32_t begin, std::uint32_t end) {
  TilePasses all;
  for (std::uint32_t tile = begin; tile < end; ++tile)
    for (int pass = 0; pass < pass_count; ++pass)
      if (film.passes_of(tile) >> pass & 1) all.push_back({tile, {pass, film.pass_pixels(tile, pass), {}}});
  return all;
}

bool is_there(const Film& film, std::uint32_t x, std::uint32_t y) {
  const std::uint32_t across = (film.size().width + tile_side - 1) / tile_side;
  int pass = 0;
  while (x % pass_stride[pass] != 0 || y % pass_stride[pass] != 0) ++pass;
  return film.passes_of(y / tile_side * across + x / tile_side) >> pass & 1;
}

/// One pixel of film.filled(): of those whose squares cover it the finest that is there; else black.
const float* filled_pixel(const Film& film, std::uint32_t x, std::uint32_t y) {
  const auto value = [&](std::uint32_t at_x, std::uint32_t at_y) {
    return &film.rgb()[3 * (std::size_t{at_y} * film.size().width + at_x)];
  };
  for (int pass = pass_count - 1; pass >= 0; --pass) {
    const std::uint32_t grid_x = x - x % pass_stride[pass], grid_y = y - y % pass_stride[pass];
    if (is_there(film, grid_x, grid_y)) return value(grid_x, grid_y);
  }
  return value(x, y);
}

}  // namespace

std::shared_ptr<const Film> film_so_far(const Farm& farm, JobId id, std::optional<std::uint32_t> frame,
                                        FarmTime now) {
  const FrameView view = frame_view(farm, id, frame, now);
  std::shared_ptr<const Film> film = farm.film(id, frame);
  if (!film && view.pixels_done > 0)
    throw ApiError(410, "the picture of " + text_of(id, frame) + " is no longer kept; submit it again");
  return film;
}

std::shared_ptr<const Film> film_snapshot(const FarmDoor& farm, JobId id,
                                          std::optional<std::uint32_t> frame) {
  struct First {
    Size size;
    std::shared_ptr<const Film> complete;
  };
  const First first = farm.ask([=](Farm& f, FarmTime now) {
    const std::shared_ptr<const Film> film = film_now(f, id, frame, now);
    return First{film->size(), film->is_complete() ? film : nullptr};
  });
  if (first.complete) return first.complete;

  const auto copy = std::make_shared<Film>(first.size);
  const std::uint32_t tiles = tile_count(first.size);
  for (std::uint32_t begin = 0; begin < tiles; begin += tiles_at_once) {
    const std::uint32_t end = std::min(begin + tiles_at_once, tiles);
    const TilePasses passes = farm.ask(
        [=](Farm& f, FarmTime now) { return passes_there(*film_now(f, id, frame, now), begin, end); });
    for (const auto& [tile, image] : passes) copy->put(tile, image);
  }
  return copy;
}

Picture preview(const Film& film, std::uint32_t longest_side) {
  const Size whole = film.size();
  const std::uint32_t step = (std::max(whole.width, whole.height) - 1) / longest_side + 1;
  if (step <= 1) return {whole, film.filled(), {}};
  Picture picture{{(whole.width + step - 1) / step, (whole.height + step - 1) / step}, {}, {}};
  for (std::uint32_t y = 0; y < whole.height; y += step)
    for (std::uint32_t x = 0; x < whole.width; x += step) {
      const float* pixel = filled_pixel(film, x, y);
      picture.rgb.insert(picture.rgb.end(), pixel, pixel + 3);
    }
  return picture;
}

}  // namespace rayfarm
