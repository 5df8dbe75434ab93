-- A golden ball on a checkered floor: the smallest scene with a shadow, a reflection and a horizon.

local gold = phong{ color = {1, 0.6, 0.1}, ambient = 0.1, diffuse = 0.6, specular = 0.4, exponent = 16 }

local ball = sphere{}
local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.5, 0, 0}:texture(checker{ 1, 1, {1, 1, 1} })

return scene{
  camera = perspective{ from = {0.7, 0.5, -5}, direction = {0, -0.18, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.8), point{ at = {-5, 3, -3}, intensity = 1 } },
  root = union{ ball, floor }:material(gold),
}
