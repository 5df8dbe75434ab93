-- Two rows of turning cubes: the front one about the vertical axis, the one behind head over heels. With -p mat=glass
-- or mirror they show one another.

local mat = param{ "mat", type = "choice", choices = { "diffuse", "mirror", "glass" }, default = "diffuse",
                   help = "what the cubes are made of" }
local n = param{ "n", type = "number", default = 1.6, min = 0.1, max = 10, help = "index of refraction of the glass" }

local materials = {
  diffuse = phong{ color = {1, 0.6, 0.1}, ambient = 0.1, diffuse = 0.8, specular = 0.2, exponent = 16 },
  mirror = phong{ color = {1, 1, 0.8}, ambient = 0, diffuse = 0.1, specular = 0.9, exponent = 128 },
  glass = phong{ color = {0, 0.2, 0.1}, ambient = 0.05, diffuse = 0.05, specular = 0.1, exponent = 128,
                 transmission = 0.9, index = n },
}
local block = cube{}:material(materials[mat])

local parts = { plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.6, 0, 0}:texture(checker{ 0.5, 0.5, {1, 1, 1} }) }
for i = 0, 4 do
  parts[#parts + 1] = block:rotate_y(math.deg(0.6 * (i + 1))):translate(2 * i - 3.5, -0.8, 0)
end
for i = 0, 6 do
  parts[#parts + 1] = block:rotate_x(math.deg(3.5 - 0.5 * i)):translate(1.5 * i - 4, 1, 2)
end

return scene{
  camera = perspective{ from = {0.7, 3, -10}, direction = {0, -0.3, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.8), point{ at = {-5, 3, -3}, intensity = 1 } },
  root = union(parts):material(materials.diffuse),
}
