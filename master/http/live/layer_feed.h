// A layer of a job on its way to all who watch it.
//
// The poller looks at where the layer comes from and makes messages of what is new: once, however many watch.
// The feed keeps the newest message of each tile, ordered by when it came. A viewer's place in a layer is one
// number: whatever came after it is sent next, so each viewer gets every tile in its newest form, and none
// twice in the same.
#pragma once
#include <map>
#include <string>

#include "common/net/messages.h"
#include "master/http/live/tile_message.h"

namespace rayfarm {

struct LayerName {
  JobId job{};
  std::optional<std::uint32_t> frame;  // none: the first
  std::string layer;                   // "picture", or a map's name
  std::string reduce;
  bool compat = false;
  auto operator<=>(const LayerName&) const = default;
};

struct NewTile {
  std::uint32_t tile = 0;
  SharedMessage message;
};
struct FeedNews {
  std::optional<LayerState> state;  // when it is another one
  std::uint32_t step = 1;
  std::vector<NewTile> tiles;
  bool is_all = true;    // there was no more to tell
  bool is_final = true;  // what was told stays
};

/// How much of a layer is sent: pictures with a side over 8192 or of more than 32 megapixels are thinned.
std::uint32_t step_for(Size size);

class LayerPoller {
 public:
  LayerPoller(std::uint32_t id, LayerSource source) : source_(std::move(source)) { sent_.id = id; }

  /// What is new, at most so many tiles. What the source throws becomes the layer's state, but
  /// for FarmUnavailable.
  FeedNews poll(std::uint32_t most_tiles);

 private:
  LayerNews look(std::uint32_t most_tiles);
  void forget_all();

  LayerSource source_;
  SentLayer sent_;
  std::vector<PassSet> known_;  // passes that are not sent count as known
  std::uint32_t losses_ = 0;    // of passes that were known
  std::optional<LayerState> state_;
};

class LayerFeed {
 public:
  LayerFeed(std::uint32_t id, LayerName name) : id_(id), name_(std::move(name)) {}

  void take(FeedNews news);
  /// Gives up its tiles, and takes no more.
  void fail(std::string message);

  std::uint32_t id() const { return id_; }
  const LayerName& name() const { return name_; }
  bool is_over() const { return is_over_; }  // nothing new will come
  /// How the layer stands; nothing before the first news. It has another version when it stands differently.
  const std::optional<LayerState>& state() const { return state_; }
  std::uint64_t state_version() const { return state_version_; }
  std::uint32_t step() const { return step_; }
  std::uint64_t bytes() const { return bytes_; }

  struct Next {
    std::uint64_t place;
    SharedMessage message;
  };
  /// The first that came after this place; nothing when there is none.
  std::optional<Next> next_after(std::uint64_t place) const;

 private:
  std::uint32_t id_;
  LayerName name_;
  std::optional<LayerState> state_;
  std::uint64_t state_version_ = 0, last_place_ = 0, bytes_ = 0;
  std::uint32_t step_ = 1;
  bool is_over_ = false;
  std::map<std::uint64_t, SharedMessage> messages_;  // by place
  std::map<std::uint32_t, std::uint64_t> place_of_;  // by tile
};

}  // namespace rayfarm
