-- Four cylinders: two endless ones that lie across each other's reflection, a finger that points at the viewer and ends
-- far behind, and a drum near the horizon that shows both caps' edges.

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0, 0.2, 0}:texture(checker{ 0.5, 0.5, {1, 1, 1} })

local pillar = cylinder{}:rotate_x(90):translate(-2.1, 0, 1)
local pipe = cylinder{}:rotate_y(math.deg(-0.4)):translate(1, 0, 1)
    :color{0.2, 0, 0.7}:texture(checker{ 12, 1, {0, 0, 0.3} })
local finger = cylinder{ 0, 100 }:rotate_y(math.deg(0.2)):translate(5, 0.3, 4):color{0.1, 0.7, 0}
local drum = cylinder{ -0.5, 0.5 }:scale(2):rotate_x(math.deg(1.2)):translate(2, 1.8, 16):color{0.8, 0.6, 0}

return scene{
  camera = perspective{ from = {0.7, 3, -10}, direction = {0, -0.2, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(1), point{ at = {-5, 3, -3}, intensity = 1.6 } },
  root = union{ floor, pillar, pipe, finger, drum }
      :material(phong{ color = {0.6, 0, 0}, ambient = 0.15, diffuse = 0.8, specular = 0.15, exponent = 16 }),
}
