-- Light without surfaces: a yellow glowing tube instead of the pillar of cylinders.lua, and a row of six turquoise
-- glowing balls, each half the size of the one before. They are mirrored but cast no shadow.

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0, 0.2, 0}:texture(checker{ 0.5, 0.5, {1, 1, 1} })

local pipe = cylinder{}:rotate_y(math.deg(-0.4)):translate(1, 0, 1)
    :color{0.2, 0, 0.7}:texture(checker{ 12, 1, {0, 0, 0.3} })
local finger = cylinder{ 0, 100 }:rotate_y(math.deg(0.2)):translate(5, 0.3, 4):color{0.1, 0.7, 0}
local drum = cylinder{ -0.5, 0.5 }:scale(2):rotate_x(math.deg(1.2)):translate(2, 1.8, 16):color{0.8, 0.6, 0}

local tube = glow_cylinder{ -5, -0.3, color = {1, 1, 0} }:scale(0.75):rotate_x(90):translate(-2.1, 0, 1)

local parts = { floor, tube, pipe, finger, drum }
for i = 0, 5 do
  parts[#parts + 1] = glow_sphere{ color = {0, 1.2, 1.2} }
      :scale(6.4 / 2^i):translate(-2.3 + 0.8 * i, 2.2 - 0.2 * i, 2)
end

return scene{
  camera = perspective{ from = {0.7, 3, -10}, direction = {0, -0.2, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(1), point{ at = {-5, 3, -3}, intensity = 1.6 } },
  root = union(parts)
      :material(phong{ color = {0.6, 0, 0}, ambient = 0.15, diffuse = 0.8, specular = 0.15, exponent = 16 }),
  image = { width = 1200, height = 800 },
}
