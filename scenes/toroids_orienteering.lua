-- Three tori in the triangles of an orienteering flag: the texture shows how u runs around a torus and v around its
-- tube.

local function flag(fu, fv) return stripes{ fu, fv, {0.7, 0, 0} } end

return scene{
  camera = perspective{ from = {0, 0, -10}, direction = {0, -0.04, 1}, angle = 60 },
  background = {0.05, 0.05, 0.05},
  lights = { ambient(1.8), point{ at = {-5, 3, -3}, intensity = 2 } },
  root = union{
    torus{ 2, 1 }:scale(0.8):rotate_x(math.deg(0.9)):translate(2.7, 1, 0):texture(flag(2, 2)),
    torus{ 1.5, 0.8 }:rotate_x(math.deg(0.8)):translate(-2.5, 0, 0):texture(flag(4, 4)),
    torus{ 2, 1 }:scale(0.6):rotate_x(math.deg(1.3)):translate(1.6, -2.2, 0):texture(flag(6, 2)),
  }:material(phong{ color = {1, 1, 1}, ambient = 0.2, diffuse = 0.8, specular = 0, exponent = 1 }),
}
