// A job's picture, from the master to a file on this PC.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/render/film.h"
#include "master/files/image_file.h"

namespace rayfarm {

/// What the master has of the job's film. Throws CommandError.
Film fetch_film(const nlohmann::json& job);

/// A complete film gives the very file that `rayfarm render` writes. Of another one the coarse pixels fill
/// the missing ones, and the header says how many are missing.
void write_job_picture(const std::string& file, const nlohmann::json& job, const Film& film, PngCurve curve);

}  // namespace rayfarm
