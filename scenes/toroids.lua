-- Tori of all proportions: a fat one, a spindle torus that a sphere has bitten open, and a row of little rings, each
-- thicker and turned a little further than the one before.

local fat = torus{ 2, 1 }:scale(0.8):rotate_x(math.deg(0.9)):translate(2.7, 0.6, 0)
    :color{0, 0, 0.7}:texture(checker{ 50, 20, {0.9, 0.9, 0} })

local spindle = difference{
  torus{ 1, 1.5 }:color{1, 0, 0}:texture(checker{ 40, 40, {0.8, 1, 1} }),
  sphere{}:scale(3):translate(0, -3, 0):color{0.5, 0.5, 0.5}:texture(checker{ 100, 100, {1, 0.5, 0} }),
}:rotate_x(math.deg(0.8)):translate(-2.5, 0, 0)

local parts = { fat, spindle }
local rings = 14
for i = 0, rings - 1 do
  local share = i / rings
  parts[#parts + 1] = torus{ 0.2, 0.01 + 0.185 * share }
      :rotate_x(math.deg(0.5 * i)):translate(-4.7 + 10 * share, -2.5, 0):color(1)
end

return scene{
  camera = perspective{ from = {0, 0, -10}, direction = {0, -0.04, 1}, angle = 60 },
  background = {0, 0.15, 0.2},
  lights = { ambient(1.8), point{ at = {-5, 3, -3}, intensity = 2 } },
  root = union(parts)
      :material(phong{ color = {0.5, 0.5, 0.5}, ambient = 0.2, diffuse = 0.7, specular = 0.2, exponent = 16 }),
}
