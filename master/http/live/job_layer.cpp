#include "master/http/live/job_layer.h"

#include "master/diagnostics/delivery_map.h"
#include "master/http/api_error.h"
#include "master/http/job_subject.h"

namespace rayfarm {
namespace {

LayerSource delivery_layer(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame,
                           const MapKind& kind) {
  struct Place {
    Size size;
    std::vector<std::uint32_t> order;  // centre first, made once
  };
  const auto place = std::make_shared<Place>();
  return [&farm, id, frame, &kind, place](const std::vector<PassSet>& known, std::uint32_t most_tiles) {
    if (place->order.empty()) {
      const RenderSettings settings = job_subject(farm, id, frame).subject.settings;
      place->size = {settings.width, settings.height};
      place->order = centre_first(place->size);
    }
    return delivery_news(job_deliveries(farm, id, frame), place->size, kind, place->order, known, most_tiles);
  };
}

}  // namespace

LayerSource map_layer(const FarmDoor& farm, Diagnostics& diagnostics, JobId id,
                      std::optional<std::uint32_t> frame, const MapRequest& request) {
  if (is_of_deliveries(*request.kind)) return delivery_layer(farm, id, frame, *request.kind);
  return
      [&farm, &diagnostics, id, frame, request](const std::vector<PassSet>& known, std::uint32_t most_tiles) {
        try {
          return diagnostics.map_news(job_subject(farm, id, frame).subject, request, known, most_tiles);
        } catch (const TooMuchAsked& error) {
          throw ApiError(503, error.what());
        }
      };
}

}  // namespace rayfarm
