// Image files for textures; the first byte says of which format.
//
// Law: an image that was read can be sent.
#include "common/scene/scene.h"
#include "master/files/texture_image.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {

void fuzz(ByteView bytes) {
  constexpr const char* names[] = {"image.png", "image.jpg", "image.exr", "image.hdr"};
  const std::string name = names[take_byte(bytes) % std::size(names)];
  AssetData data;
  try {
    data = asset_data(read_texture_image(name, text_of(bytes)));
  } catch (const SceneError&) {
    return;
  }
  require(decode_asset(data).content() != nullptr, "an image that was read can be sent");
}

}  // namespace rayfarm
