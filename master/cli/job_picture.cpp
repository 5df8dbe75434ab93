#include "master/cli/job_picture.h"

#include "common/net/codec.h"
#include "master/cli/exit_code.h"
#include "master/cli/frame_files.h"
#include "master/files/film_picture.h"
#include "master/http/settings_json.h"

namespace rayfarm {

using nlohmann::json;

json frames_of(JobNumber job) { return get_json(job_target(job) + "/frames").at("frames"); }

bool is_animation(const json& job) { return job.at("frames").at("total") > 1; }

Film fetch_film(JobNumber job, std::uint32_t frame) {
  const std::string bytes = get_bytes(job_target(job) + "/film?frame=" + std::to_string(frame));
  try {
    return decode_film({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  } catch (const CodecError& error) {
    throw CommandError(ExitCode::failed,
                       std::string("the picture arrived damaged (") + error.what() + "); try again");
  }
}

void write_job_picture(const std::string& file, const json& job, const json& frame, const Film& film,
                       PngCurve curve) {
  RenderSettings settings = settings_from_json(job.at("settings"));
  settings.frame = frame.at("frame");
  write_picture(file, film_picture(film, frame.at("scene_hash"), settings), curve);
}

void FrameWriter::write_done(const json& job) {
  const json& version = job.at("frames").at("version");
  if (version == seen_ && job.at("frames").at("done") == written_.size()) return;
  seen_ = version;
  const JobNumber id = job.at("id");
  for (const json& frame : frames_of(id)) {
    const std::uint32_t number = frame.at("frame");
    if (frame.at("state") != "done") {
      written_.erase(number);  // somebody had lied: it is rendered again
      continue;
    }
    const auto written = written_.find(number);
    if (written != written_.end() && written->second == frame.at("version")) continue;
    if (!frame.at("is_kept").get<bool>())
      throw CommandError(ExitCode::failed, "the master no longer keeps the picture of frame " +
                                               std::to_string(number) + " of job " + std::to_string(id) +
                                               "; render it again with --frame " + std::to_string(number));
    write_job_picture(frame_file(file_, number), job, frame, fetch_film(id, number), curve_);
    written_[number] = frame.at("version");
  }
}

std::vector<std::string> FrameWriter::files() const {
  std::vector<std::string> files;
  for (const auto& [frame, version] : written_) files.push_back(frame_file(file_, frame));
  return files;
}

}  // namespace rayfarm
