// A video of pictures that are there as files, made by ffmpeg when it is installed.
#pragma once
#include <string>
#include <vector>

namespace rayfarm {

/// Throws SettingsError when ffmpeg is not in the PATH, the pictures are none that a video is made of (.png), or the file's
/// name is of no kind of video; FileError when it cannot be written.
void check_video(const std::string& file, const std::string& pictures);
/// The kind of video is that of the file's name. What was there before stays until the video is complete. Throws
/// FileError.
void write_video(const std::string& file, const std::vector<std::string>& pictures, double frames_per_second);

}  // namespace rayfarm
