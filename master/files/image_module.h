// What the module rayfarm-images offers: the only code that links OpenImageIO.
//
// Linking OpenImageIO costs 0.25 s at start and 133 MB, so the module is opened when a picture is first read
// or written. Both sides are built together: C++ values may cross.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/scene/image.h"
#include "master/files/image_file.h"

namespace rayfarm {

using FileBytes = std::vector<std::uint8_t>;

struct ImageModule {
  FileBytes (*exr)(const Picture& picture);
  /// `bytes`: the picture's values already as 0..255.
  FileBytes (*png)(const Picture& picture, std::span<const std::uint8_t> bytes, PngCurve curve);
  /// The header's strings come as facts; a PNG's curve as "oiio:ColorSpace".
  Picture (*read)(const std::filesystem::path& file);
  ChannelGroup (*channels)(const std::filesystem::path& file, const std::vector<std::string>& names);
  /// From the bytes of a file of that name; opens none.
  Image (*texture)(const std::string& name, std::string_view bytes);
};

/// The module, opened at the first call. Throws FileError when it is not installed.
const ImageModule& image_module();

}  // namespace rayfarm

extern "C" const rayfarm::ImageModule* rayfarm_images();
