#include "master/http/live/layer_feed.h"

#include <algorithm>
#include <utility>

#include "master/http/farm_door.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t longest_side = 8192;
constexpr std::uint64_t most_pixels = 32'000'000;

}  // namespace

std::uint32_t step_for(Size size) {
  const auto fits = [&](std::uint32_t step) {
    const std::uint64_t width = (size.width + step - 1) / step, height = (size.height + step - 1) / step;
    return std::max(width, height) <= longest_side && width * height <= most_pixels;
  };
  std::uint32_t step = 1;
  while (step < pass_stride[0] && !fits(step)) step *= 2;
  return step;
}

LayerNews LayerPoller::look(std::uint32_t most_tiles) {
  if (known_.empty()) {  // nothing is asked for before it is known which passes are sent
    const LayerState state = source_({}, 0).state;
    sent_.size = state.size, sent_.channels = state.channels;
    sent_.step = step_for(state.size);
    forget_all();
  }
  LayerNews seen = source_(known_, most_tiles);
  if (std::exchange(losses_, seen.losses) == seen.losses) return seen;
  forget_all();  // all are told again: it is rare
  seen = source_(known_, most_tiles);
  losses_ = seen.losses;
  return seen;
}

void LayerPoller::forget_all() {
  known_.assign(tile_count(sent_.size), static_cast<PassSet>(all_passes & ~passes_sent(sent_.step)));
}

FeedNews LayerPoller::poll(std::uint32_t most_tiles) {
  LayerNews seen;
  try {
    seen = look(most_tiles);
  } catch (const FarmUnavailable&) {
    throw;  // it may be there the next time
  } catch (const std::exception& error) {
    seen.state = state_.value_or(LayerState{});
    seen.state.state = LayerProgress::failed;
    seen.state.message = error.what();
  }
  FeedNews news{{}, sent_.step, {}, seen.tiles.size() < most_tiles, seen.is_final};
  for (const TileNews& tile : seen.tiles) {
    known_.at(tile.tile) |= tile.passes;
    if (SharedMessage message = tile_message(sent_, tile))
      news.tiles.push_back({tile.tile, std::move(message)});
  }
  if (state_ != seen.state) news.state = state_ = std::move(seen.state);
  return news;
}

void LayerFeed::take(FeedNews news) {
  if (is_over_) return;
  step_ = news.step;
  if (news.state) {
    state_ = std::move(news.state);
    ++state_version_;
  }
  is_over_ = news.is_all && news.is_final && state_ && state_->state == LayerProgress::done;
  for (NewTile& tile : news.tiles) {
    std::uint64_t& place = place_of_[tile.tile];
    if (const auto old = messages_.find(place); old != messages_.end()) {
      bytes_ -= old->second->size();
      messages_.erase(old);
    }
    bytes_ += tile.message->size();
    place = ++last_place_;
    messages_.emplace_hint(messages_.end(), place, std::move(tile.message));
  }
}

void LayerFeed::fail(std::string message) {
  is_over_ = true;
  if (!state_) state_.emplace();
  state_->state = LayerProgress::failed;
  state_->message = std::move(message);
  ++state_version_;
  messages_.clear();
  bytes_ = 0;
}

std::optional<LayerFeed::Next> LayerFeed::next_after(std::uint64_t place) const {
  const auto next = messages_.upper_bound(place);
  if (next == messages_.end()) return std::nullopt;
  return Next{next->first, next->second};
}

}  // namespace rayfarm
