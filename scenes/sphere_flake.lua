-- The sphere flake: a ball that carries seven smaller flakes, and so on. Depth 5 has 2,801 spheres, depth 7 137,257.

local depth = param{ "depth", type = "int", default = 5, min = 1, max = 8, help = "levels of balls" }
local coef = param{ "coef", type = "number", default = 0.4, min = 0.01, max = 1,
                    help = "size of a flake relative to the one that carries it" }
local mat = param{ "mat", type = "choice", choices = { "diffuse", "mirror", "glass" }, default = "diffuse",
                   help = "what the balls are made of" }
local n = param{ "n", type = "number", default = 1.6, min = 0.1, max = 10, help = "index of refraction of the glass" }

local materials = {
  diffuse = phong{ color = {1, 0.6, 0.1}, ambient = 0.1, diffuse = 0.85, specular = 0.05, exponent = 16 },
  mirror = phong{ color = {1, 1, 0.8}, ambient = 0, diffuse = 0.1, specular = 0.9, exponent = 128 },
  glass = phong{ color = {0, 0.2, 0.1}, ambient = 0.05, diffuse = 0.05, specular = 0.1, exponent = 128,
                 transmission = 0.9, index = n },
}

-- One flake stands on top; three pairs of opposite ones lean away from it, a third of a turn apart.
local lean = 2 * math.deg(math.atan(1, math.sqrt(2)))   -- 70.53 degrees

local function flake(depth)
  local parts = { sphere{} }
  if depth > 1 then
    local top = flake(depth - 1):scale(coef):translate(0, 1 + coef, 0)
    parts[2] = top
    for turn = 0, 240, 120 do
      parts[#parts + 1] = top:rotate_x(lean):rotate_y(turn)
      parts[#parts + 1] = top:rotate_x(lean + 180):rotate_y(turn)
    end
  end
  return union(parts)
end

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.3, 0, 0}:texture(checker{ 0.6, 0.6, {1, 1, 1} })

return scene{
  camera = perspective{ from = {1.6, 2.2, -7}, direction = {-0.12, -0.3, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.8), point{ at = {-5, 4, -3}, intensity = 1.2 } },
  root = union{ flake(depth):material(materials[mat]), floor }
      :material(phong{ color = {1, 0.8, 0.1}, ambient = 0.1, diffuse = 0.6, specular = 0.4, exponent = 128 }),
}
