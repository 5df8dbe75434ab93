// A small animation: a cube that turns, seen by a camera that comes nearer.
#pragma once

namespace rayfarm {

/// Frames 0 to 20, from second 1 to 3.
constexpr const char* turning_scene = R"(-- A cube that turns.
local glass = phong{ color = {0, 0.2, 0.1}, ambient = 0.05, diffuse = 0.05, specular = 0.1, transmission = 0.9 }
return scene{
  camera = perspective{ from = {0, 0.5, -8 + time}, direction = {0, -0.1, 1}, angle = 50 },
  background = {0, 0.05, 0.1 * time},
  lights = { ambient(0.5), point{ at = {-5, 5, -5} } },
  root = union{
    cube{}:translate(-0.5, -0.5, -0.5):rotate_y(36 * time):color{1, 0.5 * math.sin(time), 0},
    sphere{}:scale(0.7):translate(-1, 0.2, -1):material(glass),
    plane{}:rotate_x(-90):translate(0, -1, 0):texture(checker{ 1, 1, {1, 1, 1} }),
  },
  image = { width = 160, height = 90, spp = 4 },
  animation = { start = 1, stop = 3, fps = 10 },
}
)";

}  // namespace rayfarm
