// Files of frames: the place of the number in a picture's name is a run of #, the last that there is. So it is for
// stills, too: those are frame 0, or that of --frame.
#pragma once
#include <cstdint>
#include <string>

namespace rayfarm {

bool has_place_for_frame(const std::string& file);
/// name.####.png of frame 7 is name.0007.png; numbers of more digits take more room. A name without a place stays
/// as it is.
std::string frame_file(const std::string& pattern, std::uint32_t frame);
/// Throws SettingsError unless the option's file has a place for the number.
void expect_place_for_frame(const std::string& option, const std::string& file);

}  // namespace rayfarm
