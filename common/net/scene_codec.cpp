// Scenes: a format number, then cereal inside one zstd frame.
#include "common/net/compress.h"
#include "common/net/scene_cereal.h"

namespace rayfarm {
namespace {

constexpr std::uint8_t scene_format = 2;
constexpr std::size_t max_raw_scene = std::size_t{1} << 30;  // bytes; max_nodes plain nodes need 0.9 GB

}  // namespace

Bytes encode_scene(const Scene& scene) {
  Bytes raw{scene_format};
  encode_to(raw, scene);
  return compress(raw);
}

Scene decode_scene(ByteView bytes) {
  DecompressedSource source(bytes, max_raw_scene);
  if (source.sbumpc() != scene_format) throw CodecError("this is no scene that this version can read");
  Scene scene = decode_from<Scene>(source);
  source.expect_end();
  check(scene);
  return scene;
}

}  // namespace rayfarm
