// A job's picture as a file, and how far two of them are apart.
#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/files/difference.h"
#include "master/files/film_picture.h"
#include "master/http/film_snapshot.h"
#include "master/http/job_subject.h"
#include "master/http/query.h"

namespace rayfarm {
namespace {

using nlohmann::json;

ApiResponse show_film(const Call& call) {
  return {200, "application/octet-stream",
          encode_film(*film_snapshot(call.doors.farm, job_id(call), whole_in(call, "frame")))};
}

Picture picture_of(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> number) {
  const std::shared_ptr<const Film> film = film_snapshot(farm, id, number);
  return farm.ask([=](Farm& f, FarmTime now) {
    const FrameView frame = frame_view(f, id, number, now);
    RenderSettings settings = f.job(id, now)->settings;
    settings.frame = frame.frame;
    return film_picture(*film, frame.scene_hash, settings);
  });
}

ApiResponse show_exr(const Call& call) {
  return {200, "image/x-exr", exr_bytes(picture_of(call.doors.farm, job_id(call), whole_in(call, "frame")))};
}

ApiResponse show_png(const Call& call) {
  constexpr WholeRange sides{.low = 1};
  const std::optional<std::uint32_t> longest_side = whole_in(call, "longest_side", sides);
  if (!longest_side)
    return {200, "image/png", png_bytes(picture_of(call.doors.farm, job_id(call), whole_in(call, "frame")))};
  const auto film = film_snapshot(call.doors.farm, job_id(call), whole_in(call, "frame"));
  return {200, "image/png", png_bytes(preview(*film, *longest_side))};
}

// Two pictures. --------------------------------------------------------------------------------------------

struct Pair {
  Picture a, b;
};

Pair pictures_of(const Call& call) {
  const FarmDoor& farm = call.doors.farm;
  Pair pair{picture_of(farm, job_id(call), whole_in(call, "frame")),
            picture_of(farm, job_id(call, 1), whole_in(call, "other_frame"))};
  if (pair.a.size == pair.b.size) return pair;
  const auto text = [](Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); };
  throw ApiError(409, "only pictures of the same size can be compared: these have " + text(pair.a.size) +
                          " and " + text(pair.b.size) + " pixels");
}

ApiResponse show_difference(const Call& call) {
  const Pair pair = pictures_of(call);
  json values;
  for (const Metric metric : {Metric::rmse, Metric::mae, Metric::max, Metric::flip})
    values[std::string(name_of(metric))] = difference(pair.a, pair.b, metric).value;
  return shown(values);
}

ApiResponse show_flip(const Call& call) {
  const Pair pair = pictures_of(call);
  return {200, "image/png", png_bytes(difference(pair.a, pair.b, Metric::flip).picture)};
}

constexpr Route routes[]{
    {"GET", "/api/v1/jobs/{id}/film?frame", show_film, Work::picture},
    {"GET", "/api/v1/jobs/{id}/picture.png?frame&longest_side", show_png, Work::picture},
    {"GET", "/api/v1/jobs/{id}/picture.exr?frame", show_exr, Work::picture},
    {"GET", "/api/v1/jobs/{id}/difference/{other}?frame&other_frame", show_difference, Work::picture},
    {"GET", "/api/v1/jobs/{id}/difference/{other}/flip.png?frame&other_frame", show_flip, Work::picture},
};

}  // namespace

std::span<const Route> picture_routes() { return routes; }

}  // namespace rayfarm
