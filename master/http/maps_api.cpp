// Maps of jobs as files.
#include <nlohmann/json.hpp>

#include "master/diagnostics/delivery_map.h"
#include "master/diagnostics/diagnostics.h"
#include "master/diagnostics/map_file.h"
#include "master/diagnostics/map_picture.h"
#include "master/http/job_subject.h"
#include "master/http/query.h"

namespace rayfarm {
namespace {

using nlohmann::json;

const char* name_of(MapScale scale) {
  switch (scale) {
    case MapScale::depth:
      return "depth";
    case MapScale::count:
      return "count";
    case MapScale::normal:
      return "normal";
    case MapScale::label:
      break;
  }
  return "label";
}

ApiResponse list_maps(const Call&) {
  json maps = json::array();
  for (const MapKind& kind : all_maps())
    maps.push_back({{"name", kind.name},
                    {"title", kind.title},
                    {"unit", kind.unit},
                    {"help", kind.help},
                    {"channels", kind.channels.size()},
                    {"scale", name_of(kind.scale)},
                    {"reduces", kind.reduces},
                    {"compat", kind.has_compatible}});
  return shown({{"maps", std::move(maps)}});
}

MapRequest map_request(const Call& call) {
  const std::string& name = call.arguments.at(1);
  MapRequest request{map_named(name)};
  if (!request.kind) throw ApiError(404, "there is no map " + name + ", but " + map_names());
  request.reduction = choice_in(call, "reduce", "majority", listed(reduction_names()),
                                [](const std::string& text) { return reduction_named(text); });
  request.compatible = switch_in(call, "compat");
  return request;
}

MapColors map_colors(const Call& call) {
  MapColors colors;
  colors.palette = choice_in(call, "scale", "original", "original or perceptual",
                             [](const std::string& text) { return palette_named(text); });
  const std::optional<double> low = real_in(call, "low"), high = real_in(call, "high");
  if (low.has_value() != high.has_value()) throw ApiError(400, "low and high come together");
  if (!low) return colors;
  if (!(*low < *high)) throw ApiError(400, "low must be less than high");
  colors.range = MapRange{*low, *high};
  return colors;
}

struct MapFormat {
  enum Kind { png, exr, csv } kind = png;
  MapColors colors;
  bool has_legend = false;
};

MapFormat map_format(const Call& call) {
  MapFormat format{MapFormat::png, map_colors(call), switch_in(call, "legend")};
  format.kind = choice_in(call, "format", "png", "png, exr or csv",
                          [](const std::string& text) -> std::optional<MapFormat::Kind> {
                            if (text == "png") return MapFormat::png;
                            if (text == "exr") return MapFormat::exr;
                            return text == "csv" ? std::optional(MapFormat::csv) : std::nullopt;
                          });
  return format;
}

ApiResponse map_file(const Map& map, const MapOrigin& origin, const MapFormat& format) {
  const MapKind& kind = *origin.request.kind;
  if (format.kind == MapFormat::csv) return {200, "text/csv; charset=utf-8", csv(map, title_of(origin))};
  Picture picture = format.kind == MapFormat::exr ? raw(map, kind)
                    : format.has_legend           ? colored_with_legend(map, kind, format.colors)
                                                  : colored(map, kind, format.colors);
  picture.facts = facts_of(origin);
  if (format.kind == MapFormat::exr) return {200, "image/x-exr", exr_bytes(picture)};
  return {200, "image/png", png_bytes(picture)};
}

/// Of a map that only the farm can tell: whole when the job is done.
ApiResponse show_delivery_map(const Call& call, const JobSubject& of, MapOrigin origin,
                              const MapFormat& format) {
  const FrameView& frame = of.frame;
  if (frame.state != JobState::done && !switch_in(call, "partial"))
    return in_the_making(static_cast<double>(frame.pixels_done) / static_cast<double>(frame.pixels_total));
  const Deliveries deliveries = job_deliveries(call.doors.farm, of.job.id, frame.frame);
  const MapKind& kind = *origin.request.kind;
  if (kind.source == MapSource::farm) origin.labels = deliveries.names;
  return map_file(delivery_map(deliveries, {origin.settings.width, origin.settings.height}, kind), origin,
                  format);
}

ApiResponse show_map(const Call& call) {
  const MapRequest request = map_request(call);
  const MapFormat format = map_format(call);
  const JobSubject of = job_subject(call.doors.farm, job_id(call), whole_in(call, "frame"));
  const Subject& subject = of.subject;
  const MapOrigin origin{request, subject.scene_hash, subject.settings};
  if (is_of_deliveries(*request.kind)) return show_delivery_map(call, of, origin, format);
  const Made<Map> made = call.doors.diagnostics.map(subject, request);
  if (made.standing.state == LayerProgress::failed) throw ApiError(500, made.standing.message);
  if (made.thing) return map_file(*made.thing, origin, format);
  if (!switch_in(call, "partial")) return in_the_making(made.standing.share_done);
  return map_file(call.doors.diagnostics.map_so_far(subject, request), origin, format);
}

constexpr Route routes[]{
    {"GET", "/api/v1/maps", list_maps},
    {"GET", "/api/v1/jobs/{id}/maps/{map}?frame&reduce&compat&format&scale&low&high&legend&partial&wait",
     show_map, Work::picture},
};

}  // namespace

std::span<const Route> map_routes() { return routes; }

}  // namespace rayfarm
