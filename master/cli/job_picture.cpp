#include "master/cli/job_picture.h"

#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/cli/exit_code.h"
#include "master/cli/master_api.h"
#include "master/files/film_picture.h"
#include "master/http/settings_json.h"

namespace rayfarm {

Film fetch_film(const nlohmann::json& job) {
  const std::string bytes = get_bytes(job_target(job.at("id")) + "/film");
  try {
    return decode_film({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  } catch (const CodecError& error) {
    throw CommandError(ExitCode::failed,
                       std::string("the picture arrived damaged (") + error.what() + "); try again");
  }
}

void write_job_picture(const std::string& file, const nlohmann::json& job, const Film& film, PngCurve curve) {
  const RenderSettings settings = settings_from_json(job.at("settings"));
  write_picture(file, film_picture(film, job.at("scene_hash"), settings), curve);
}

}  // namespace rayfarm
