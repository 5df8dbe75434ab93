// Mesh files, by their ending.
//
// Law: a mesh that was read can be sent and rendered.
#pragma once
#include "common/scene/scene.h"
#include "master/script/mesh_import.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {

inline void fuzz_mesh(const std::string& name, ByteView bytes) {
  AssetData data;
  try {
    data = asset_data(read_mesh(name, text_of(bytes)));
  } catch (const SceneError&) {
    return;
  }
  require(decode_asset(data).facets() != nullptr, "a mesh that was read can be sent and rendered");
}

}  // namespace rayfarm
