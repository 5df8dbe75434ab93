// What can be known of a picture beside its pixels, made when somebody asks and kept for the next one.
//
// Everything follows from a scene and settings alone, so it is the same before, while and after a farm renders
// them. Maps, statistics and clouds are made in the background; they are done when their questions find them so.
// Maps that follow from the same samples come together, as far as there is room for what nobody asked for.
// All calls are made from any thread; none but scene() and trace() takes long.
#pragma once
#include <memory>
#include <optional>

#include "master/diagnostics/background.h"
#include "master/diagnostics/cloud.h"
#include "master/diagnostics/growing_map.h"
#include "master/diagnostics/pixel_trace.h"
#include "master/diagnostics/shelf.h"
#include "master/diagnostics/statistics.h"
#include "master/diagnostics/world_cache.h"

namespace rayfarm {

/// What is looked into.
struct Subject {
  std::string scene_hash;  // of the bytes
  SharedBytes scene;       // encode_scene()
  RenderSettings settings;
  std::vector<AssetData> assets{};  // that the scene shows
};

constexpr std::size_t most_rays_recorded = 20'000;  // of a trace

/// Something that is being made, or was.
template <class Thing>
struct Made {
  Standing standing;
  std::shared_ptr<const Thing> thing;  // when it is done
};

/// What is kept, and how much may be asked for at once.
struct DiagnosticsLimits {
  ShelfLimits maps{.bytes = 512 << 20, .wanted = std::uint64_t{2} << 30, .things = 1000};
  ShelfLimits clouds{.bytes = 128 << 20, .wanted = 512 << 20, .things = 100};
  ShelfLimits statistics{.bytes = 256 << 20, .wanted = std::uint64_t{1} << 30, .things = 1000};
  WorldCache::Limits worlds;
};

constexpr std::uint32_t most_cloud_points = 2'000'000;
struct CloudRequest {
  CloudOptions options;
  std::uint32_t points = 200'000;  // at most, evenly over the picture
  bool operator==(const CloudRequest&) const = default;
};
using PlyFile = std::vector<std::uint8_t>;

class Diagnostics {
 public:
  explicit Diagnostics(unsigned threads, Clock now = steady_now, const DiagnosticsLimits& limits = {});
  /// Waits for the scenes that are being built, for all else not much longer than a ray takes.
  ~Diagnostics();

  // Each call keeps its subject's map in the making. The kind must have values without a farm. They throw
  // TooMuchAsked.
  LayerNews map_news(const Subject& subject, const MapRequest& request, const std::vector<PassSet>& known,
                     std::uint32_t most_tiles);
  Made<Map> map(const Subject& subject, const MapRequest& request);
  /// With what is there of it, as fill() spreads it; infinite where nothing is.
  Map map_so_far(const Subject& subject, const MapRequest& request);
  /// Throws TooMuchAsked.
  Made<Statistics> statistics(const Subject& subject);
  /// Throws TooMuchAsked.
  Made<PlyFile> cloud(const Subject& subject, const CloudRequest& request);

  /// Builds it unless it is here. Throws what the scene's decoding throws.
  std::shared_ptr<const ReadyScene> scene(const Subject& subject);

  /// At once, with at most so many rays. Throws SettingsError for what the picture has not got.
  PixelTrace trace(const Subject& subject, Pixel pixel, const SampleChoice& choice, std::uint32_t story_ray);

  /// All that is in work ends within a few hundred rays, and nothing more is made.
  void stop();

  /// One part of what is being made, on the calling thread; false: there is nothing to do.
  bool work_once() { return background_.work_once(); }

 private:
  template <class Request>
  struct Key {
    std::string scene_hash;
    RenderSettings settings;
    Request request;
    bool operator==(const Key&) const = default;
  };
  struct Nothing {
    bool operator==(const Nothing&) const = default;
  };
  /// The product and the task that fills it.
  template <class Product>
  struct InMaking {
    std::shared_ptr<Product> product;
    Background::TaskRef task;
  };
  struct GrowingStatistics {
    std::mutex mutex;  // guards total until all parts are done
    Statistics total;
  };

  struct PassOfTile {
    std::uint32_t tile;
    int pass;
  };

  struct GrowingCloud {
    std::atomic<double> share{0};
    PlyFile file;  // when it is done
  };

  std::shared_ptr<InMaking<GrowingMap>> map_in_making(const Subject& subject, const MapRequest& request);
  std::shared_ptr<InMaking<GrowingMap>> new_map(const Subject& subject, const MapRequest& request);
  bool make_part_of_map(const Subject& subject, const MapRequest& request, GrowingMap& map, PassOfTile part,
                        const Background::Stop& stop);

  std::atomic<bool> stopping_{false};
  WorldCache worlds_;
  Shelf<Key<MapRequest>, InMaking<GrowingMap>> maps_;
  Shelf<Key<Nothing>, InMaking<GrowingStatistics>> statistics_;
  Shelf<Key<CloudRequest>, InMaking<GrowingCloud>> clouds_;
  Background background_;  // last: its threads end before what they use
};

}  // namespace rayfarm
