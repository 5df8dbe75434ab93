-- A golden, checkered cloth of two Bezier patches, lifted where its control points are high; a green post stands through
-- it, a red one behind.

-- Heights of the control points over a grid of unit steps; the middle column belongs to both patches.
local heights = {
  { 0, 0, 0, 0,   0, 0, 0 },
  { 0, 0, 3, 3,   3, 0, 0 },
  { 0, 0, 0, 1.5, 3, 0, 0 },
  { 0, 0, 0, 0,   0, 0, 0 },
}
local points = {}
for row, line in ipairs(heights) do
  points[row] = {}
  for column, height in ipairs(line) do
    points[row][column] = { column - 1, height, #heights - row }
  end
end
local cloth = bezier{ points }:rotate_y(math.deg(-0.4)):translate(-1.1, -0.9, 0)
    :texture(checker{ 10.5, 12, {0, 0, 0.1} })

local function paint(color)
  return phong{ color = color, ambient = 0.2, diffuse = 0.6, specular = 0.3, exponent = 8 }
end
local post = cylinder{}:rotate_x(90)
local green = post:scale(0.15):translate(-0.4, 0, 0):material(paint{0, 0.6, 0})
local red = post:scale(0.2):translate(-1.9, 0, 3):material(paint{0.8, 0.2, 0})

local floor = plane{}:rotate_x(-90):translate(0, -1, 0)
    :color{0.3, 0, 0}:texture(checker{ 0.6, 0.6, {1, 1, 1} })

return scene{
  camera = perspective{ from = {0.7, 0.5, -5}, direction = {0, -0.18, 1}, angle = 50 },
  background = {0, 0.05, 0.07},
  lights = { ambient(0.8), point{ at = {-5, 3, -3}, intensity = 1 } },
  root = union{ cloth, green, red, floor }
      :material(phong{ color = {1, 0.8, 0.1}, ambient = 0.1, diffuse = 0.5, specular = 0.5, exponent = 64 }),
}
