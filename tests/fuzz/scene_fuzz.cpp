// Scenes: first as damaged bytes, then as the content of sound ones, which no fuzzer would find behind the compression.
//
// Laws: a scene that was decoded is encoded to bytes that decode to the same, and it can be rendered.
#include "common/net/compress.h"
#include "common/render/render.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

/// Scenes without assets, and small enough that a ray is quick.
void render(Scene scene) {
  constexpr std::size_t most_nodes = 40;
  if (scene.nodes.size() > most_nodes || scene.lights.size() > 4) return;
  RenderSettings settings;
  settings.width = 4, settings.height = 3, settings.spp = 1, settings.max_depth = 3;
  const World world(std::move(scene));
  require(render_tile(world, settings, 0, all_passes, [] { return false; }).has_value(),
          "a scene that was decoded can be rendered");
}

void decode(ByteView bytes) try {
  Scene scene = decode_scene(bytes);
  const Bytes once = encode_scene(scene);
  require(encode_scene(decode_scene(once)) == once, "a scene that was sent on is the same scene");
  render(std::move(scene));
} catch (const CodecError&) {
} catch (const SceneError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  decode(bytes);
  decode(compress(bytes));
}

}  // namespace rayfarm
