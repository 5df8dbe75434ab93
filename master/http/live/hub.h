// What all viewers are shown, and how far each has come; without sockets.
//
// Pull, not push: a viewer is asked what it needs next only when it has got what it was sent before. State and
// layers are shown as they are then, whatever happened meanwhile; only the lines of the log are all sent. So a
// viewer costs a few numbers, however slowly it reads.
#pragma once
#include <optional>
#include <set>

#include "master/event_log.h"
#include "master/http/live/layer_feed.h"

namespace rayfarm {

constexpr std::size_t most_layers_watched = 8;  // by one viewer

struct LiveMessage {
  SharedMessage bytes;
  bool is_text = true;
};

/// What is to be looked up for the viewers.
struct LiveWish {
  struct Layer {
    std::uint32_t id = 0;
    LayerName name;
  };
  bool state_is_missing = true;
  std::uint64_t log_after = 0;
  std::vector<Layer> layers;
};
/// What was found.
struct LiveNews {
  SharedMessage state;  // null: as it was
  std::vector<LogLine> lines;
  FarmTime now{};
  struct Layer {
    std::uint32_t id = 0;
    FeedNews news;
  };
  std::vector<Layer> layers;
};

/// What everybody may be shown.
struct LiveBoard {
  SharedMessage state;
  std::uint64_t state_version = 0;
  EventLog log;
  FarmTime now{};
};

class Viewer {
 public:
  /// Replaces what was watched; a layer that stays goes on where it was.
  void watch(std::vector<std::shared_ptr<const LayerFeed>> feeds);
  /// What to send next; nothing when it has seen all there is.
  std::optional<LiveMessage> next(const LiveBoard& board);

 private:
  struct Watched {
    std::shared_ptr<const LayerFeed> feed;
    std::uint64_t state_version = 0;   // that was sent
    std::uint64_t place = 0;           // of the last tile that was sent
    bool has_tiles_of_its_own = true;  // an earlier one of the same layer is sent them already
  };

  std::optional<LiveMessage> next_tile();

  std::uint64_t state_version_ = 0, log_number_ = 0;
  std::vector<Watched> watched_;
  std::size_t turn_ = 0;  // which of them is next: none waits until another is complete
};

class LiveHub {
 public:
  explicit LiveHub(std::uint64_t memory = std::uint64_t{1} << 30) : memory_(memory) {}

  /// One feed for all who watch the layer; it is there while somebody does.
  std::shared_ptr<const LayerFeed> feed(const LayerName& name);
  LiveWish wish();
  void take(LiveNews news);
  /// Nobody looks: what was shown grows old.
  void clear() { board_.state = nullptr; }
  const LiveBoard& board() const { return board_; }

 private:
  /// Feeds that are watched.
  std::vector<std::shared_ptr<LayerFeed>> living();
  void keep_within_memory();

  const std::uint64_t memory_;  // bytes for all tiles of all layers
  std::map<LayerName, std::weak_ptr<LayerFeed>> feeds_;
  std::uint32_t last_id_ = 0;
  LiveBoard board_;
};

}  // namespace rayfarm
