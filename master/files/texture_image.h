// Images for textures, from the bytes of a file. Called in the limited child only: the bytes come from anywhere.
#pragma once
#include <string>
#include <string_view>

#include "common/scene/image.h"

namespace rayfarm {

/// Any format that OpenImageIO reads from memory (PNG, JPEG, EXR, HDR, ...), told by the name's ending. One or two
/// channels are a grey; alpha is not looked at. Eight bits are sRGB codes; of others, what the file calls linear stays as
/// it is and all else is decoded from sRGB. Throws SceneError.
Image read_texture_image(const std::string& name, std::string_view bytes);

/// Opens what read_texture_image() needs, as long as files may be opened.
void prepare_to_read_images();

}  // namespace rayfarm
