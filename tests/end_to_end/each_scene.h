// Laws that hold for the pictures of all bundled scenes.
#pragma once
#include <chrono>
#include <random>
#include <thread>

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

  void start_workers_to_kill() {
    for (unsigned i = 0; i < workers_to_kill; ++i) start_worker("pc" + std::to_string(i));
  }
  /// Kills some of them at random instants while the job runs, and starts them again.
  void kill_workers(const std::string& id, std::mt19937& random) {
    constexpr int most = 8;  // then it may finish
    for (int kills = 0; kills < most && state_of(id) != "done"; ++kills) {
      // A random instant: nothing is waited for.
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 30));
      const std::string victim = "pc" + std::to_string(random() % workers_to_kill);
      kill_worker(victim);
      start_worker(victim);
    }
  }

 private:
  static constexpr unsigned workers_to_kill = 3;
};

/// Pictures of 20 tiles, some of them narrow.
inline std::vector<ScenePicture> five_scenes() {
  const Words options{"--size", "300x220", "--spp", "4"};
  return {{"SpherePlane", Words{scene_file("sphere_plane")} + options},
          {"HedgehogInTheCage", Words{scene_file("hedgehog_in_the_cage")} + options},
          {"Circus", Words{scene_file("circus")} + options},
          {"SphereFlake", Words{scene_file("sphere_flake")} + options},
          {"TestScene", Words{scene_file("test_scene")} + options},
          {"TestSceneRectLight", Words{scene_file("test_scene"), "-p", "light=rectangle"} + options}};
}

/// Of 6 tiles.
inline std::vector<ScenePicture> other_scenes() {
  const Words options{"--size", "150x100", "--spp", "4"};
  return {{"TwoSpheres", Words{scene_file("two_spheres")} + options},
          {"FiveBalls", Words{scene_file("five_balls")} + options},
          {"Cubes", Words{scene_file("cubes"), "-p", "mat=glass"} + options},
          {"Cylinders", Words{scene_file("cylinders")} + options},
          {"CylindersGlow", Words{scene_file("cylinders_glow")} + options},
          {"Toroids", Words{scene_file("toroids")} + options},
          {"ToroidsOrienteering", Words{scene_file("toroids_orienteering")} + options},
          {"Optics", Words{scene_file("optics")} + options},
          {"OpticsRayCasting", Words{scene_file("optics"), "-p", "rc=true"} + options},
          {"Bezier", Words{scene_file("bezier")} + options},
          {"Glasshenge", Words{scene_file("glasshenge")} + options},
          {"Flags", Words{scene_file("flags")} + options},
          {"AnimatedScene", Words{scene_file("animated_scene"), "--frame", "77"} + options}};
}

inline std::string name_of_case(const testing::TestParamInfo<ScenePicture>& info) { return info.param.name; }

}  // namespace rayfarm
