-- An animation of 20 seconds: the camera goes once around a glass ball and a golden one.

local n = param{ "n", type = "number", default = 1.6, min = 0.1, max = 10, help = "index of refraction of the glass" }

local start, stop = 0, 20   -- seconds
local angle = 2 * math.pi * (time - start) / (stop - start)

local centre = {0.7, -0.4, 0}
local away, above = 6, 1.2   -- of the camera, from the centre
local from = { centre[1] + away * math.sin(angle), centre[2] + above, centre[3] - away * math.cos(angle) }
local towards = { centre[1] - from[1], centre[2] - from[2], centre[3] - from[3] }

local glass = phong{ color = {0, 0.2, 0.1}, ambient = 0.03, diffuse = 0.03, specular = 0.08, exponent = 128,
                     transmission = 0.9, index = n }
local gold = phong{ color = {1, 0.8, 0.1}, ambient = 0.1, diffuse = 0.6, specular = 0.4, exponent = 128 }

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.2, 0.03, 0}:texture(checker{ 0.6, 0.6, {1, 1, 1} })

return scene{
  camera = perspective{ from = from, direction = towards, angle = 50 },
  background = {0, 0.01, 0.03},
  lights = { ambient(0.8), point{ at = {-5, 4, -3}, intensity = 1.2 } },
  root = union{ sphere{}:material(glass), sphere{}:scale(1.2):translate(1.5, 0.2, 2.4), floor }:material(gold),
  image = { width = 320, height = 180, spp = 4 },
  animation = { start = start, stop = stop, fps = 25 },
}
