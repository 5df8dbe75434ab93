-- A glass ball with a bite in front of a ring, a post and a checkered floor: rays of every kind and fate at one pixel.
--   rayfarm trace glass.lua --pixel 290,280 --json > glass.json
local glass = phong{ color = {0.3, 0.6, 1}, ambient = 0.1, diffuse = 0.3, specular = 0.3, exponent = 64, transmission = 0.8, index = 1.5 }
local red = phong{ color = {0.9, 0.25, 0.2}, ambient = 0.2, diffuse = 0.7, specular = 0.2, exponent = 32 }
local bitten = difference{ sphere{}:name("ball"), cube{}:translate(0.1, 0.1, -1.2):name("bite") }:name("bitten"):material(glass)
return scene{
  camera = perspective{ from = {0.7, 1.2, -5}, direction = {-0.1, -0.2, 1}, angle = 50 },
  background = {0.02, 0.06, 0.09},
  lights = { ambient(0.8), point{ at = {-5, 4, -3}, intensity = 1 }, rectangle{ at = {3, 3, -2}, width = {1, 0, 0}, height = {0, 0, 1}, intensity = 1, dim = {1, 0.04, 0} } },
  root = union{ bitten, torus{ R = 1.1, r = 0.2 }:translate(0.4, 0, 2.4):material(red):name("ring"), cylinder{ zmin = -1, zmax = 1 }:scale(0.3, 0.3, 0.3):rotate_x(90):translate(-2, -0.7, 0.5):material(red):name("post"),
    plane{}:rotate_x(-90):translate(0, -1, 0):color{0.3, 0, 0}:texture(checker{ 0.6, 0.6, {1, 1, 1} }):name("floor"):material(red) },
}
