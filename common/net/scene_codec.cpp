// Scenes: a format number, then cereal inside one zstd frame.
#include <algorithm>

#include "common/net/compress.h"
#include "common/net/scene_cereal.h"

namespace rayfarm {
namespace {

/// Raised whenever the bytes of a scene change their meaning: see SceneCodec.TheFormatsNumberChangesWithTheBytes.
constexpr std::uint8_t scene_format = 3;
constexpr std::size_t max_raw_scene = std::size_t{1} << 30;  // bytes; max_nodes plain nodes need 0.9 GB

}  // namespace

Bytes encode_scene(const Scene& scene) {
  Bytes raw{scene_format};
  encode_to(raw, scene);
  return compress(raw);
}

namespace {

/// Puts the contents of the scene's assets in their places.
void find_assets(Scene& scene, std::span<const Asset> assets) {
  if (scene.assets.size() > max_assets) throw CodecError("the scene has more assets than may be");
  for (Asset& wanted : scene.assets) {
    const auto found = std::ranges::find(assets, wanted);
    if (found == assets.end())
      throw CodecError("the scene's asset " + wanted.digest().substr(0, 8) + " is not here");
    wanted = *found;
  }
}

}  // namespace

Scene decode_scene(ByteView bytes, std::span<const Asset> assets) {
  DecompressedSource source(bytes, max_raw_scene);
  if (source.sbumpc() != scene_format) throw CodecError("this is no scene that this version can read");
  Scene scene = decode_from<Scene>(source);
  source.expect_end();
  find_assets(scene, assets);
  check(scene);
  return scene;
}

}  // namespace rayfarm
