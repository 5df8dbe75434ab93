// Laws that hold for the pictures of all bundled scenes.
#pragma once
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {

struct ScenePicture {
  std::string name;  // of the test
  Words picture;     // script and options
};

inline void PrintTo(const ScenePicture& scene, std::ostream* out) { *out << scene.name; }

class EachScene : public FarmPrograms, public testing::WithParamInterface<ScenePicture> {
 protected:
  const Words& picture() const { return GetParam().picture; }
};

/// Pictures of 20 tiles, some of them narrow.
inline std::vector<ScenePicture> all_scenes() {
  const Words options{"--size", "300x220", "--spp", "4"};
  return {{"SpherePlane", Words{scene_file("sphere_plane")} + options},
          {"HedgehogInTheCage", Words{scene_file("hedgehog_in_the_cage")} + options},
          {"Circus", Words{scene_file("circus")} + options},
          {"SphereFlake", Words{scene_file("sphere_flake")} + options},
          {"TestScene", Words{scene_file("test_scene")} + options},
          {"TestSceneRectLight", Words{scene_file("test_scene"), "-p", "light=rectangle"} + options}};
}

inline std::string name_of_case(const testing::TestParamInfo<ScenePicture>& info) { return info.param.name; }

}  // namespace rayfarm
