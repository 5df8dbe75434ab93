-- Two balls on a checkered floor: one of glass (or -p mat=mirror, diffuse), through which the golden one behind and
-- the floor are seen upside down.

local mat = param{ "mat", type = "choice", choices = { "glass", "diffuse", "mirror" }, default = "glass",
                   help = "what the ball in front is made of" }
local n = param{ "n", type = "number", default = 1.6, min = 0.1, max = 10, help = "index of refraction of the glass" }
local schlick = param{ "schlick", type = "number", default = 1, min = 0, max = 1,
                       help = "how much more is mirrored at grazing angles" }

local materials = {
  glass = phong{ color = {0, 0.2, 0.1}, ambient = 0.05, diffuse = 0.05, specular = 0.1, exponent = 128,
                 transmission = 0.9, index = n, schlick = schlick },
  diffuse = phong{ color = {0.1, 0.1, 0.6}, ambient = 0.1, diffuse = 0.8, specular = 0.2, exponent = 16,
                   schlick = schlick },
  mirror = phong{ color = {1, 1, 0.8}, ambient = 0.01, diffuse = 0, specular = 1.1, exponent = 8192,
                  schlick = schlick },
}
local gold = phong{ color = {1, 0.7, 0.1}, ambient = 0.1, diffuse = 0.7, specular = 0.3, exponent = 128,
                    schlick = schlick }

local front = sphere{}:material(materials[mat])
local behind = sphere{}:scale(1.2):translate(1.5, 0.2, 2.4)
local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.3, 0, 0}:texture(checker{ 0.6, 0.6, {1, 1, 1} })

return scene{
  camera = perspective{ from = {0.7, 0.5, -5}, direction = {0, -0.18, 1}, angle = 50 },
  background = {0, 0.01, 0.03},
  lights = { ambient(0.8), point{ at = {-5, 4, -3}, intensity = 1.2 } },
  root = union{ front, behind, floor }:material(gold),
  image = { width = 640, height = 480 },
}
