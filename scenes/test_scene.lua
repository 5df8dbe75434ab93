-- The test scene: a shiny ball on a checkered floor, lit by a point or (-p light=rectangle) by a tall thin lamp,
-- whose shadow is soft on one side only.

local light = param{ "light", type = "choice", choices = { "point", "rectangle" }, default = "point",
                     help = "a sharp or a soft shadow" }

local lamps = {
  point = point{ at = {-5, 4, -3}, intensity = 1.2 },
  rectangle = rectangle{ at = {-5, 1, -3}, width = {0, 0, 0.1}, height = {0, 6, 0}, intensity = 2.2,
                         dim = {1, 0.04, 0} },
}

local shiny = phong{ color = {1, 0.8, 0.1}, ambient = 0.1, diffuse = 0.6, specular = 0.4, exponent = 128 }

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.3, 0, 0}:texture(checker{ 0.6, 0.6, {1, 1, 1} })

return scene{
  camera = perspective{ from = {0.7, 0.5, -5}, direction = {0, -0.18, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.8), lamps[light] },
  root = union{ sphere{}, floor }:material(shiny),
}
