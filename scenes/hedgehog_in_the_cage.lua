-- The hedgehog in the cage, a wire puzzle of spheres alone: a sphere stretched a thousandfold serves as a cylinder
-- or as a slab. Set operations three levels deep.

local long = 1000   -- stretched so far, a sphere's side is straight

local function pillar(radius) return sphere{}:scale(radius, long, radius) end
local function slab(half_height) return sphere{}:scale(long, half_height, long) end

-- The cage: a hollow drum, open at the top and the bottom, with three slots through it.
local drum = intersection{ pillar(1), slab(1.5) }
local slot = intersection{ slab(1.1), sphere{}:scale(0.4, long, long) }
local cage = difference{ drum, drum:scale(0.9), pillar(0.5), slot, slot:rotate_y(60), slot:rotate_y(-60) }
    :color{0.7, 0.93, 0.2}:name("cage")

-- The hedgehog: a ball with six spikes; where a spike ends is decided by a ball shifted along it.
local function spike(shift) return intersection{ pillar(0.06), sphere{}:scale(1.2):translate(0, shift, 0) } end
local hedgehog = union{
  sphere{}:scale(0.48),
  spike(0),
  spike(0.1):rotate_x(-60),
  spike(-0.25):rotate_x(-60):rotate_y(-72),
  spike(0.2):rotate_x(-60):rotate_y(-144),
  spike(-0.2):rotate_x(-60):rotate_y(72),
  spike(-0.25):rotate_x(-60):rotate_y(144),
}:color{0.4, 0.05, 0.05}:name("hedgehog")

local tilt = math.deg(0.1)
local puzzle = union{
  cage:rotate_y(math.deg(0.25)),
  hedgehog:rotate({0, 1, 1}, tilt):translate(0, -0.1, 0),
}:rotate_z(tilt)

return scene{
  camera = perspective{ from = {0, 2, -7}, direction = {0, -0.32, 1}, angle = 40 },
  background = {0, 0.05, 0.05},
  lights = { ambient(0.8), point{ at = {-8, 5, -3}, intensity = 1 } },
  root = union{ puzzle }
      :material(phong{ color = {0.5, 0.5, 0.5}, ambient = 0.2, diffuse = 0.6, specular = 0.2, exponent = 16 }),
}
