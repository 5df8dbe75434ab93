-- Five balls in a row, each half mirrored in its neighbours; the last one shows how a checker wraps around a sphere.

local colors = { {0.1, 0.3, 1}, {0.2, 0.9, 0.5}, {1, 0.6, 0}, {1, 0.2, 0.2}, {0.1, 0.4, 0} }

local balls = {}
for i, color in ipairs(colors) do
  balls[i] = sphere{}:translate(2.2 * (i - 3), 0, 0):color(color)
end
balls[5] = balls[5]:texture(checker{ 80, 40, {1, 0.8, 0.2} })

-- The one in the middle comes first, as in the original.
balls = { balls[3], balls[2], balls[1], balls[4], balls[5] }

return scene{
  camera = perspective{ from = {0, 0, -10}, direction = {0, 0, 1}, angle = 60 },
  background = {0, 0.05, 0.05},
  lights = { ambient(0.8), point{ at = {-5, 3, -3}, intensity = 1 } },
  root = union(balls)
      :material(phong{ color = {0.5, 0.5, 0.5}, ambient = 0.1, diffuse = 0.6, specular = 0.3, exponent = 16 }),
}
