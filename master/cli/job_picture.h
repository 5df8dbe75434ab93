// A job's pictures, from the master to files on this PC.
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/render/film.h"
#include "master/cli/master_api.h"
#include "master/files/image_file.h"

namespace rayfarm {

/// All frames that the job will have, as the master tells of them.
nlohmann::json frames_of(JobNumber job);
/// Whether the job has more than one.
bool is_animation(const nlohmann::json& job);

/// What the master has of the frame's film. Throws CommandError.
Film fetch_film(JobNumber job, std::uint32_t frame);

/// A complete film gives the very file that `rayfarm render` writes. Of another one the coarse pixels fill
/// the missing ones, and the header says how many are missing.
void write_job_picture(const std::string& file, const nlohmann::json& job, const nlohmann::json& frame,
                       const Film& film, PngCurve curve);

/// Writes pictures of a job as its frames are done, and once more when they had to be rendered again.
class FrameWriter {
 public:
  /// The file has a place for the frame's number, unless the job has one frame.
  FrameWriter(std::string file, PngCurve curve) : file_(std::move(file)), curve_(curve) {}

  /// Those that are done and not yet written as they are. Throws CommandError when the master no longer keeps one.
  void write_done(const nlohmann::json& job);
  /// Written so far.
  std::vector<std::string> files() const;

 private:
  std::string file_;
  PngCurve curve_;
  std::map<std::uint32_t, nlohmann::json> written_;  // their pictures' versions
  nlohmann::json seen_;                              // the version of all
};

}  // namespace rayfarm
