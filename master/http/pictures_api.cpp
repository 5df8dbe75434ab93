// A job's picture as a file.
#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/files/image_file.h"
#include "master/http/film_snapshot.h"
#include "master/http/route.h"

namespace rayfarm {
namespace {

ApiResponse show_film(const Call& call) {
  return {200, "application/octet-stream", encode_film(*film_snapshot(call.doors.farm, job_id(call)))};
}

ApiResponse show_picture(const Call& call) {
  return {200, "image/png", png_bytes(preview(*film_snapshot(call.doors.farm, job_id(call))))};
}

constexpr Route routes[]{
    {"GET", "/api/v1/jobs/{id}/film", show_film, Work::picture},
    {"GET", "/api/v1/jobs/{id}/picture.png", show_picture, Work::picture},
};

}  // namespace

std::span<const Route> picture_routes() { return routes; }

}  // namespace rayfarm
