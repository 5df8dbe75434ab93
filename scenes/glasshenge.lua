-- Stonehenge of glass, seen all around by a fisheye camera that stands in its middle: the picture's rim is what lies
-- behind.

local function rad(angle) return math.deg(angle) end   -- angles below are radians
local upright = 4.7   -- a little less than three quarters of a turn: lintels are not quite level

local function stone(width, height, depth) return cube{}:scale(width, height, depth) end

local function trilithon(pillar, gap, lintel)
  return union{ pillar, pillar:translate(gap, 0, 0), lintel:rotate_z(rad(upright)):translate(-3.5, 4, 0) }
end

local leaning = stone(1, 4, 1):rotate_y(rad(-0.5))
local pillar = stone(1.5, 4, 1):rotate_y(rad(0.6))

local henge = union{
  union{
    pillar:translate(0, 0, 1.5),
    pillar:translate(2, 0, 3.5),
    stone(0.7, 5, 1.5):rotate_z(-90):rotate_y(rad(-0.8)):translate(1, 4.5, 0),
  }:translate(-7.5, 0, 3.5),
  union{ stone(0.8, 4, 1.5), stone(0.8, 4, 1.5):translate(2, 0, 0) }:rotate_y(rad(-0.2)):translate(-0.5, 0, 8.5),
  union{
    leaning,
    stone(1, 7, 1):rotate_x(rad(-0.7)):rotate_y(rad(-0.5)):translate(-2.5, 0, 3.5),
  }:translate(9, 0, 5.5),
  union{
    stone(1.1, 4, 0.8),
    stone(1.4, 2.2, 1):translate(0, 0, -3),
    stone(1.2, 4, 0.9):rotate_x(rad(4.2)):translate(0, 4, 0.5),
  }:translate(-8, -1, -1.5),
  union{ stone(1.5, 4, 1):rotate_z(rad(2.3)):rotate_x(rad(4.7)) }:translate(-1, 0, -8.5),
  trilithon(stone(0.8, 4, 1.5), -3.5, stone(0.7, 5, 1.5)):rotate_y(rad(2.6)):translate(3, 0, -9),
  trilithon(stone(0.8, 4, 1.3), -2.5, stone(0.5, 5, 1.7)):rotate_y(90):translate(10.5, 0, -1.5),
}:translate(0, -1, 0)
    :material(phong{ color = {0.2, 0.2, 0.15}, ambient = 0.05, diffuse = 0.05, specular = 0.1, exponent = 128,
                     transmission = 0.8, index = 2.8 })

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.9, 0.8, 0.1}:texture(checker{ 0.6, 0.6, {0.1, 0.1, 1} })

return scene{
  camera = fisheye{ from = {0, 2, 4}, direction = {0, 0, 1}, angle = 360 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.1), point{ at = {-5, 4, -3}, intensity = 1.5 } },
  root = union{ henge, floor }
      :material(phong{ color = {1, 0.8, 0.1}, ambient = 0.1, diffuse = 0.6, specular = 0.4, exponent = 128 }),
  image = { width = 640, height = 640 },
}
