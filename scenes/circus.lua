-- The circus: a clown and his colleagues, made with all four set operations, xor within difference too.

local skin, black, white = {1, 0.8, 0.65}, {0, 0, 0}, {1, 1, 1}
local red, blue, orange, pink, lime = {1, 0, 0}, {0, 0, 1}, {1, 0.3, 0}, {1, 0.3, 1}, {0.5, 0.8, 0.2}

local function ball(radius, color, x, y, z)
  return sphere{}:scale(radius):translate(x or 0, y or 0, z or 0):color(color)
end
local disc = cylinder{ -0.5, 0.5 }

-- The clown. ---------------------------------------------------------------------------------------------------

local head = difference{ ball(2.3, skin), ball(0.7, skin, -0.7, 0.3, -1.8), ball(0.7, skin, 0.7, 0.3, -1.8) }

local hat = union{
  disc:scale(2, 2, 1.4):rotate_x(90):translate(0, 0.5, 0):color(black),
  disc:scale(3, 3, 0.1):rotate_x(90):color(black),
}:translate(0, 1.25, 0)

local eye = union{ ball(1.3, white), ball(0.3, blue, 0, 0, -1.2) }

local nose = disc:scale(0.2, 0.2, 0.6):translate(0, 0, -2.65):color(skin)

local lower, upper = disc:translate(0, -0.3, 0), disc:translate(0, 0.3, 0)
local mouth = xor{
  lower:color(red),
  upper:color(red),
  intersection{ lower:color(black), upper:color(black) }:translate(0, 0, 0.1),
}:scale(0.7, 0.3, 1):translate(0, -0.7, -1.85)

local clown = union{ head, hat, eye:translate(0.7, 0.3, -0.5), eye:translate(-0.7, 0.3, -0.5), nose, mouth }
    :name("clown")

-- Balls with dents, and what is inside one set of balls but not in their xor. ----------------------------------

local dented = {
  ball(2, pink),
  ball(1, lime, 0, 0, -2),
  ball(1, orange, 0, 1, -0.5),
  ball(1, orange, 1, 0, -0.5),
  ball(1, orange, 0, -1, -0.5),
  ball(1, orange, -1, 0, -0.5),
}

-- A row of overlapping discs, from green to red. ---------------------------------------------------------------

local row = {}
for i = 0, 4 do
  row[#row + 1] = disc:rotate_x(45):translate(0.6 * i - 1, 0, 0):color{0.2 * i, 1 - 0.2 * i, 0}
end

local lens = intersection{ ball(1, pink, -0.3, 0, 0), ball(1, orange, 0.2, 0, -0.2) }

return scene{
  camera = perspective{ from = {0, 0, -11}, direction = {0, 0, 1}, angle = 60 },
  background = {0.5, 0.7, 0.6},
  lights = { ambient(1), point{ at = {-5, 3, -3}, intensity = 1.2 } },
  root = union{
    clown:translate(-6, 1.5, 0):scale(0.7):rotate_y(18),
    difference(dented):translate(0, 1.5, 0):scale(0.7),
    difference{ union(dented), xor(dented) }:translate(6, 1.5, 0):scale(0.6):rotate_x(60):rotate_y(45),
    difference{ union(row), xor(row) }:translate(-5, -2.5, 0):scale(0.7),
    xor(row):translate(0, -2.5, 0):scale(0.7),
    lens:translate(4, -1.5, 0),
  }:material(phong{ color = {0.5, 0.5, 0.5}, ambient = 0.2, diffuse = 0.8, specular = 0.1, exponent = 16 }),
}
