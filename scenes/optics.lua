-- Optics of glass: a ball with a square tunnel, a whole ball behind it, and a thin lens in front, which turns the
-- floor upside down. -p rc=true shows what they look like by plain ray casting.

local n = param{ "n", type = "number", default = 1.6, min = 0.1, max = 10, help = "index of refraction of the glass" }
local rc = param{ "rc", default = false, help = "plain ray casting: no shadows, no reflections, no refractions" }

local gold = phong{ color = {1, 0.8, 0.1}, ambient = 0.1, diffuse = 0.6, specular = 0.4, exponent = 128 }
local glass = rc
  and phong{ color = {0.1, 0.3, 1}, ambient = 0.1, diffuse = 0.8, specular = 0.1, exponent = 32,
             transmission = 0.9, index = n }
  or phong{ color = {0, 0.2, 0.1}, ambient = 0.05, diffuse = 0.05, specular = 0.1, exponent = 128,
            transmission = 0.9, index = n }

local ball = sphere{}:material(glass)
local tunnel = cube{}:translate(-0.5, -0.5, -0.5):scale(0.6, 0.6, 4):rotate_y(math.deg(-0.3)):material(glass)
local lens = intersection{ ball, ball:translate(0, 0, -1.85) }:translate(1.1, -0.55, -1)
local behind = sphere{}:scale(1.2):translate(1.5, 0.2, 2.4)
if not rc then behind = behind:material(glass) end

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.5, 0, 0}:texture(checker{ 6, 6, {1, 1, 1} })

return scene{
  camera = perspective{ from = {0.7, 0.5, -5}, direction = {0, -0.18, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.8), point{ at = {-5, 4, -3}, intensity = 1.2 } },
  root = union{ difference{ ball, tunnel }, behind, lens, floor }:material(gold),
  image = { shadows = not rc, reflections = not rc, refractions = not rc },
}
