#include "master/script/lua_scene.h"

#include "common/render/settings.h"
#include "master/script/lua_nodes.h"
#include "master/script/script_run.h"

namespace rayfarm {
namespace {

const Signature phong_signature{
    "phong", {"color", "ambient", "diffuse", "specular", "exponent", "transmission", "index", "schlick"}};
const Signature checker_signature{"checker", {"fu", "fv", "color"}, 3};
const Signature stripes_signature{"stripes", {"fu", "fv", "color"}, 3};
const Signature perspective_signature{"perspective", {"from", "direction", "up", "angle"}};
const Signature fisheye_signature{"fisheye", {"from", "direction", "up", "angle"}};
const Signature parabolic_signature{"parabolic", {"from", "direction", "up", "radius", "size"}};
const Signature orthographic_signature{"orthographic", {"from", "direction", "up", "width"}};
const Signature ambient_signature{"ambient", {}};
const Signature point_signature{"point", {"at", "intensity"}};
const Signature rectangle_signature{"rectangle", {"at", "width", "height", "intensity", "dim"}};
const Signature scene_signature{
    "scene", {"camera", "background", "lights", "root", "image", "animation", "nested_media"}};
const Signature image_signature{"image", {"width", "height", "spp", "shadows", "reflections", "refractions"}};
const Signature animation_signature{"animation", {"start", "stop", "fps"}};

// Surfaces. -------------------------------------------------------------------------------------------------

int make_phong(lua_State* L) {
  const Fields fields(L, 1, phong_signature);
  Material m;
  m.color = fields.color("color", m.color);
  m.ambient = fields.number("ambient", m.ambient, Range::not_negative);
  m.diffuse = fields.number("diffuse", m.diffuse, Range::not_negative);
  m.specular = fields.number("specular", m.specular, Range::not_negative);
  m.exponent = fields.integer("exponent", m.exponent, 0, max_exponent);
  m.transmission = fields.number("transmission", m.transmission, Range::not_negative);
  m.index = fields.number("index", m.index, Range::positive);
  m.schlick = fields.number("schlick", m.schlick, Range::not_negative);
  push_value(L, m);
  return 1;
}

template <class Squares>
int push_squares(lua_State* L, const Signature& signature) {
  const Fields fields(L, 1, signature);
  Squares texture;
  texture.fu = fields.number("fu", texture.fu);
  texture.fv = fields.number("fv", texture.fv);
  texture.color = fields.color("color", texture.color);
  push_value(L, Texture{texture});
  return 1;
}
int make_checker(lua_State* L) { return push_squares<Checker>(L, checker_signature); }
int make_stripes(lua_State* L) { return push_squares<Stripes>(L, stripes_signature); }

// Camera and lights. ----------------------------------------------------------------------------------------

/// A camera's place and directions, as all cameras have them.
template <class Kind>
Kind read_camera(const Fields& fields) {
  Kind camera;
  camera.from = fields.vector("from", camera.from);
  camera.direction = fields.vector("direction", camera.direction);
  camera.up = fields.vector("up", camera.up);
  return camera;
}

int make_perspective(lua_State* L) {
  const Fields fields(L, 1, perspective_signature);
  auto camera = read_camera<PerspectiveCamera>(fields);
  camera.angle_deg = fields.number("angle", camera.angle_deg);
  if (!(camera.angle_deg > 0 && camera.angle_deg < 180))
    throw SceneError("perspective: angle must be above 0 and below 180 degrees");
  push_value(L, Camera{camera});
  return 1;
}

int make_fisheye(lua_State* L) {
  const Fields fields(L, 1, fisheye_signature);
  auto camera = read_camera<FisheyeCamera>(fields);
  camera.angle_deg = fields.number("angle", camera.angle_deg);
  if (!(camera.angle_deg > 0 && camera.angle_deg <= 360))
    throw SceneError("fisheye: angle must be above 0 and at most 360 degrees");
  push_value(L, Camera{camera});
  return 1;
}

int make_parabolic(lua_State* L) {
  const Fields fields(L, 1, parabolic_signature);
  auto camera = read_camera<ParabolicCamera>(fields);
  camera.radius = fields.number("radius", camera.radius, Range::positive);
  camera.size = fields.number("size", camera.size, Range::not_negative);
  push_value(L, Camera{camera});
  return 1;
}

int make_orthographic(lua_State* L) {
  const Fields fields(L, 1, orthographic_signature);
  auto camera = read_camera<OrthographicCamera>(fields);
  camera.width = fields.number("width", camera.width, Range::positive);
  push_value(L, Camera{camera});
  return 1;
}

/// ambient(0.8) or ambient{r, g, b}: the one function that takes a plain colour.
int make_ambient(lua_State* L) {
  push_value(L, Light{AmbientLight{color_at(L, 1, "ambient: the intensity")}});
  return 1;
}

int make_point(lua_State* L) {
  const Fields fields(L, 1, point_signature);
  fields.require("at");
  PointLight light;
  light.at = fields.vector("at", light.at);
  light.intensity = fields.color("intensity", light.intensity);
  push_value(L, Light{light});
  return 1;
}

int make_rectangle(lua_State* L) {
  const Fields fields(L, 1, rectangle_signature);
  for (const char* key : {"at", "width", "height"}) fields.require(key);
  RectangleLight light;
  light.at = fields.vector("at", light.at);
  light.width = fields.vector("width", light.width);
  light.height = fields.vector("height", light.height);
  light.intensity = fields.color("intensity", light.intensity);
  light.dim = fields.vector("dim", light.dim, Range::not_negative);
  if (light.dim == glm::dvec3(0.0))
    throw SceneError("rectangle: dim must not be all zeros, {1, 0, 0} means no dimming");
  push_value(L, Light{light});
  return 1;
}

// The whole. ------------------------------------------------------------------------------------------------

std::vector<Light> read_lights(lua_State* L, const Fields& fields) {
  std::vector<Light> lights;
  if (!fields.push("lights")) return lights;
  if (lua_type(L, -1) != LUA_TTABLE)
    throw SceneError("scene: lights must be a list of lights, is " + description(L, -1));
  const lua_Unsigned count = lua_rawlen(L, -1);
  if (count > max_lights)
    throw SceneError("scene: lights has more than " + std::to_string(max_lights) + " entries");
  lua_Unsigned entries = 0;
  for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) ++entries;
  if (entries != count) throw SceneError("scene: lights must be a plain list without holes and keys");
  for (lua_Unsigned i = 1; i <= count; ++i, lua_pop(L, 1)) {
    lua_rawgeti(L, -1, static_cast<lua_Integer>(i));
    lights.push_back(value_at<Light>(L, -1, "scene: lights: entry " + std::to_string(i)));
  }
  lua_pop(L, 1);
  return lights;
}

ImageDefaults read_image(lua_State* L, const Fields& scene) {
  ImageDefaults image;
  if (!scene.push("image")) return image;
  const Fields fields(L, -1, image_signature);
  const auto read = [&](const char* key, std::uint32_t most) -> std::optional<std::uint32_t> {
    if (!fields.has(key)) return std::nullopt;
    return fields.integer(key, 1, 1, most);
  };
  image = {read("width", max_side),
           read("height", max_side),
           read("spp", max_spp),
           fields.boolean("shadows", true),
           fields.boolean("reflections", true),
           fields.boolean("refractions", true)};
  lua_pop(L, 1);
  return image;
}

std::optional<Animation> read_animation(lua_State* L, const Fields& scene) {
  if (!scene.push("animation")) return std::nullopt;
  const Fields fields(L, -1, animation_signature);
  Animation animation;
  animation.start = fields.number("start", animation.start);
  fields.require("stop");
  animation.stop = fields.number("stop", animation.stop);
  animation.fps = fields.number("fps", animation.fps, Range::positive);
  lua_pop(L, 1);
  return animation;
}

int make_scene(lua_State* L) {
  const Fields fields(L, 1, scene_signature);
  ScriptRun& run = run_of(L);
  if (run.scene) throw SceneError("scene: may be called only once in a script");
  Scene scene;
  if (fields.push("camera")) {
    scene.camera = value_at<Camera>(L, -1, "scene: camera");
    lua_pop(L, 1);
  }
  scene.background = fields.color("background", scene.background);
  scene.lights = read_lights(L, fields);
  scene.image = read_image(L, fields);
  scene.animation = read_animation(L, fields);
  scene.nested_media = fields.boolean("nested_media", scene.nested_media);
  fields.require("root");
  fields.push("root");
  append_tree(L, -1, scene);
  scene.assets = run.assets.assets();
  if (run.missing_files.empty()) check(scene);
  run.scene = std::move(scene);
  lua_newuserdatauv(L, 0, 0);
  luaL_setmetatable(L, LuaName<SceneMark>::value);
  return 1;
}

/// Values without methods: x.y is a mistake that should be seen.
int no_fields(lua_State* L) {
  throw SceneError(description(L, 1) + " has no fields, asked for " + description(L, 2));
}

void open_type(lua_State* L, const char* name) {
  luaL_newmetatable(L, name);
  lua_pushcfunction(L, guarded<no_fields>);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);
}

}  // namespace

void open_scene(lua_State* L) {
  for (const char* type : {LuaName<Material>::value, LuaName<Texture>::value, LuaName<Camera>::value,
                           LuaName<Light>::value, LuaName<SceneMark>::value})
    open_type(L, type);
  lua_register(L, "phong", guarded<make_phong>);
  lua_register(L, "checker", guarded<make_checker>);
  lua_register(L, "stripes", guarded<make_stripes>);
  lua_register(L, "perspective", guarded<make_perspective>);
  lua_register(L, "fisheye", guarded<make_fisheye>);
  lua_register(L, "parabolic", guarded<make_parabolic>);
  lua_register(L, "orthographic", guarded<make_orthographic>);
  lua_register(L, "ambient", guarded<make_ambient>);
  lua_register(L, "point", guarded<make_point>);
  lua_register(L, "rectangle", guarded<make_rectangle>);
  lua_register(L, "scene", guarded<make_scene>);
}

const std::vector<Signature>& scene_signatures() {
  static const std::vector<Signature> all{phong_signature,        checker_signature, stripes_signature,
                                          perspective_signature,  fisheye_signature, parabolic_signature,
                                          orthographic_signature, ambient_signature, point_signature,
                                          rectangle_signature,    scene_signature,   image_signature,
                                          animation_signature};
  return all;
}

}  // namespace rayfarm
