-- Six flags as set operations: Latvia by xor, Czechia by dents, Croatia with a coat of arms cut to shape, Brazil,
-- Finland as a carved egg, Cuba on stairs.

local red, white, blue = {1, 0, 0}, {1, 1, 1}, {0, 0, 1}
local tilt = 22.5

local function block(width, height, depth)   -- about the origin
  return cube{}:translate(-0.5, -0.5, -0.5):scale(width, height, depth)
end
local function diamond(width, height, depth)   -- a square on its tip
  return cube{}:translate(-0.5, -0.5, -0.5):rotate_z(45):scale(width, height, depth)
end

local crimson = {0.3, 0, 0}
local latvia = intersection{
  block(4, 2, 0.4):translate(0, 0, 0.2):color(crimson),
  xor{ block(4, 2, 2):color(crimson), block(4.2, 0.5, 0.5):color(white) },
}

local czechia = difference{
  sphere{}:color(0.2),
  sphere{}:translate(0, 0.8, -1):color(white),
  sphere{}:translate(0, -0.8, -1.1):color(red),
  sphere{}:translate(-1, 0, -0.8):color(blue),
}

local function bar(color, y)
  return block(4, 0.6, 0.6):rotate_x(45):translate(0.5, y, 1):color(color)
end
local shield = union{ sphere{}:color(white), block(1.8, 1.8, 1.8):translate(0, 1, 0):color(white) }
local croatia = union{
  bar(red, 1),
  bar(white, 0.3),
  bar(blue, -0.4),
  intersection{
    block(2, 2, 0.4):color(red):texture(checker{ 10, 10, white }),
    shield:scale(0.5, 0.33, 0.5):translate(0.44, -0.5, 0),
  }:scale(0.8):translate(0.4, 0.5, 0),
}

local brazil = union{
  block(4, 2, 0.2):color{0, 0.8, 0},
  diamond(2, 1, 0.4):color{1, 1, 0},
  sphere{}:scale(0.5):color(blue),
}

local finland = difference{
  sphere{}:scale(2, 1, 0.5):translate(0, 0, 0.3):color(white),
  block(4.2, 0.5, 0.5):color(blue),
  block(0.5, 4.2, 0.5):translate(-0.5, 0, 0):color(blue),
}

local stairs = {}
for i = 0, 4 do
  stairs[#stairs + 1] = block(4, 0.4, 0.4):translate(0, -0.4 * i, 0.8 - 0.2 * i):color(i % 2 == 0 and blue or white)
end
stairs[#stairs + 1] = intersection{
  diamond(2, 2, 2):color(red),
  block(4, 4, 4):translate(2, 0, 0):color(red),
}:scale(0.7):translate(-2.0001, -0.8, 0.4999)
local cuba = union(stairs)

return scene{
  camera = perspective{ from = {0, 0, -10}, direction = {0, 0, 1}, angle = 60 },
  background = {0, 0.05, 0.05},
  lights = { ambient(0.8), point{ at = {-5, 3, -3}, intensity = 1 }, point{ at = {5, 3, -3}, intensity = 1 } },
  root = union{
    latvia:scale(0.7):rotate_x(tilt):translate(-3.5, 1.5, 0),
    czechia:scale(1.6, 1, 1):rotate_y(tilt):translate(4, -1.5, 0),
    croatia:scale(0.8):rotate_y(tilt):translate(-0.4, 1.5, 1),
    brazil:scale(0.9):rotate_y(-tilt):translate(0, -1.8, 1),
    finland:scale(0.7):translate(3.5, 1.5, 0),
    cuba:scale(0.7):rotate_y(tilt):translate(-4, -1, 0),
  }:material(phong{ color = {0.5, 0.5, 0.5}, ambient = 0.2, diffuse = 0.7, specular = 0.1, exponent = 16 }),
}
