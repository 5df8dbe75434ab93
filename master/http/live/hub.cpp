#include "master/http/live/hub.h"

#include <algorithm>

#include "master/http/live/json.h"

namespace rayfarm {

// A viewer. -----------------------------------------------------------------------------------------------

void Viewer::watch(std::vector<std::shared_ptr<const LayerFeed>> feeds) {
  std::vector<Watched> watched;
  for (std::shared_ptr<const LayerFeed>& feed : feeds) {
    const auto same = [&](const Watched& w) { return w.feed == feed; };
    const auto before = std::ranges::find_if(watched_, same);
    const bool is_first = std::ranges::none_of(watched, same);
    watched.push_back({feed, 0, before == watched_.end() ? 0 : before->place, is_first});
  }
  watched_ = std::move(watched);
  turn_ = 0;
}

std::optional<LiveMessage> Viewer::next(const LiveBoard& board) {
  if (board.state && state_version_ != board.state_version) {
    state_version_ = board.state_version;
    return LiveMessage{board.state};
  }
  if (log_number_ != board.log.last()) {
    const std::vector<LogLine> lines = board.log.after(log_number_);
    log_number_ = board.log.last();
    return LiveMessage{log_message(lines, board.now)};
  }
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    Watched& w = watched_[i];
    if (!w.feed->state() || w.state_version == w.feed->state_version()) continue;
    w.state_version = w.feed->state_version();
    return LiveMessage{layer_message(*w.feed, i)};
  }
  return next_tile();
}

std::optional<LiveMessage> Viewer::next_tile() {
  for (std::size_t tried = 0; tried < watched_.size(); ++tried) {
    Watched& w = watched_[turn_++ % watched_.size()];
    if (!w.has_tiles_of_its_own) continue;
    std::optional<LayerFeed::Next> next = w.feed->next_after(w.place);
    if (!next) continue;
    w.place = next->place;
    return LiveMessage{std::move(next->message), false};
  }
  return std::nullopt;
}

// All of them. --------------------------------------------------------------------------------------------

std::shared_ptr<const LayerFeed> LiveHub::feed(const LayerName& name) {
  std::weak_ptr<LayerFeed>& known = feeds_[name];
  if (std::shared_ptr<LayerFeed> feed = known.lock()) return feed;
  auto feed = std::make_shared<LayerFeed>(++last_id_, name);
  known = feed;
  return feed;
}

std::vector<std::shared_ptr<LayerFeed>> LiveHub::living() {
  std::erase_if(feeds_, [](const auto& feed) { return feed.second.expired(); });
  std::vector<std::shared_ptr<LayerFeed>> all;
  for (const auto& [name, feed] : feeds_) all.push_back(feed.lock());
  return all;
}

LiveWish LiveHub::wish() {
  LiveWish wish{board_.state == nullptr, board_.log.last(), {}};
  for (const std::shared_ptr<LayerFeed>& feed : living())
    if (!feed->is_over()) wish.layers.push_back({feed->id(), feed->name()});
  return wish;
}

void LiveHub::take(LiveNews news) {
  board_.now = news.now;
  if (news.state) {
    board_.state = std::move(news.state);
    ++board_.state_version;
  }
  for (LogLine& line : news.lines) board_.log.add(std::move(line));
  for (const std::shared_ptr<LayerFeed>& feed : living())
    for (LiveNews::Layer& layer : news.layers)
      if (layer.id == feed->id()) feed->take(std::move(layer.news));
  keep_within_memory();
}

/// The one that was asked for last is given up first.
void LiveHub::keep_within_memory() {
  std::vector<std::shared_ptr<LayerFeed>> feeds = living();
  std::ranges::sort(feeds, {}, [](const auto& feed) { return feed->id(); });
  std::uint64_t bytes = 0;
  for (const std::shared_ptr<LayerFeed>& feed : feeds) {
    if (bytes + feed->bytes() > memory_)
      feed->fail("too many large pictures are watched at once; look at fewer of them");
    bytes += feed->bytes();
  }
}

}  // namespace rayfarm
