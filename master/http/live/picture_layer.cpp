#include "master/http/live/picture_layer.h"

#include <algorithm>
#include <memory>

#include "master/http/api_error.h"
#include "master/http/film_snapshot.h"
#include "master/http/job_subject.h"

namespace rayfarm {
namespace {

LayerState state_of(const JobView& job, const FrameView& frame) {
  LayerState state;
  state.size = {job.settings.width, job.settings.height};
  state.channels = 3;
  state.share_done = static_cast<double>(frame.pixels_done) / static_cast<double>(frame.pixels_total);
  if (frame.state == JobState::done) state.state = LayerProgress::done;
  if (frame.state == JobState::cancelled || frame.state == JobState::failed) {
    state.state = LayerProgress::failed;
    state.message =
        text_of(job.id) + (frame.state == JobState::failed ? " failed: " + job.message : " was cancelled");
  }
  return state;
}

TileNews tile_of(const Film& film, std::uint32_t number) {
  const Tile tile = tile_at(film.size(), number);
  const std::size_t row = 3 * std::size_t{tile.x1 - tile.x0};
  TileNews news{number, film.passes_of(number), {}};
  news.values.reserve(row * (tile.y1 - tile.y0));
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    const float* begin = film.rgb().data() + 3 * (std::size_t{y} * film.size().width + tile.x0);
    news.values.insert(news.values.end(), begin, begin + row);
  }
  return news;
}

std::vector<TileNews> new_tiles(const Film& film, const std::vector<std::uint32_t>& order,
                                const std::vector<PassSet>& known, std::uint32_t most_tiles) {
  std::vector<TileNews> tiles;
  for (const std::uint32_t tile : order) {
    if (tiles.size() >= most_tiles) break;
    const PassSet is_known = known.empty() ? PassSet{0} : known[tile];
    if (film.passes_of(tile) & ~is_known) tiles.push_back(tile_of(film, tile));
  }
  return tiles;
}

class PictureLayer {
 public:
  PictureLayer(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame)
      : farm_(&farm), id_(id), frame_(frame) {}

  LayerNews operator()(const std::vector<PassSet>& known, std::uint32_t most_tiles) {
    if (!complete_) return news_from_farm(known, most_tiles);
    return {state_, new_tiles(*complete_, *order_, known, most_tiles), losses_, true};
  }

 private:
  struct Look {
    LayerNews news;
    std::shared_ptr<const Film> complete;
  };

  LayerNews news_from_farm(const std::vector<PassSet>& known, std::uint32_t most_tiles) {
    Look look =
        farm_->ask([id = id_, number = frame_, order = order_, known, most_tiles](Farm& farm, FarmTime now) {
          const std::shared_ptr<const Film> film = film_so_far(farm, id, number, now);
          const FrameView frame = frame_view(farm, id, number, now);
          Look seen{{state_of(*farm.job(id, now), frame), {}, frame.losses, frame.is_final},
                    frame.is_final && film && film->is_complete() ? film : nullptr};
          if (film && order) seen.news.tiles = new_tiles(*film, *order, known, most_tiles);
          return seen;
        });
    if (!order_)
      order_ = std::make_shared<const std::vector<std::uint32_t>>(centre_first(look.news.state.size));
    state_ = look.news.state, losses_ = look.news.losses;
    complete_ = std::move(look.complete);
    return std::move(look.news);
  }

  const FarmDoor* farm_;
  JobId id_;
  std::optional<std::uint32_t> frame_;
  std::shared_ptr<const std::vector<std::uint32_t>> order_;  // of the tiles, once the size is known
  LayerState state_;                                         // when last asked
  std::uint32_t losses_ = 0;
  std::shared_ptr<const Film> complete_;
};

}  // namespace

LayerSource picture_layer(const FarmDoor& farm, JobId job, std::optional<std::uint32_t> frame) {
  return PictureLayer(farm, job, frame);
}

}  // namespace rayfarm
