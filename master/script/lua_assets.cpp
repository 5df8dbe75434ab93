#include "master/script/lua_assets.h"

#include "master/files/texture_image.h"
#include "master/script/mesh_import.h"
#include "master/script/node_value.h"
#include "master/script/script_run.h"

namespace rayfarm {
namespace {

const Signature mesh_signature{"mesh", {"file", "smooth"}};
const Signature bezier_signature{"bezier", {"points"}, 1};
const Signature picture_signature{"picture", {"file", "fu", "fv", "smooth"}};

/// The asset that `read` makes of the file that the fields name. One that is not here yet is asked for; until it
/// comes, any number will do: the scene is not used.
template <class Read>
std::uint32_t asset_of_file(lua_State* L, const Fields& fields, Read read) {
  fields.require("file");
  const std::string name = *fields.text("file");
  if (name.empty() || name.size() > 1000) throw SceneError(fields.place("file") + " must be a file's name");
  ScriptRun& run = run_of(L);
  if (const std::uint32_t* known = run.assets.of_file(name)) return *known;
  const auto file = run.files.find(name);
  if (file == run.files.end()) {
    run.missing_files.insert(name);
    return 0;
  }
  return run.assets.add_file(name, read(name, file->second));
}

int make_mesh(lua_State* L) {
  const Fields fields(L, 1, mesh_signature);
  Mesh mesh;
  mesh.smooth = fields.boolean("smooth", mesh.smooth);
  mesh.asset = asset_of_file(L, fields, read_mesh);
  return push_content(L, mesh);
}

int make_picture(lua_State* L) {
  const Fields fields(L, 1, picture_signature);
  ImageTexture texture;
  texture.fu = fields.number("fu", texture.fu);
  texture.fv = fields.number("fv", texture.fv);
  texture.smooth = fields.boolean("smooth", texture.smooth);
  texture.asset = asset_of_file(L, fields, read_texture_image);
  push_value(L, Texture{texture});
  return 1;
}

// Bezier surfaces. ------------------------------------------------------------------------------------------

/// How many entries the list at the top has; it must be 3 n + 1, n > 0.
std::size_t length_of_border(lua_State* L, const std::string& what) {
  if (lua_type(L, -1) != LUA_TTABLE) throw SceneError(what + " must be a list, is " + description(L, -1));
  const lua_Unsigned length = lua_rawlen(L, -1);
  if (length < 4 || length % 3 != 1)
    throw SceneError(what + " must have 4, 7, 10, ... entries (3 for each patch and 1), has " +
                     std::to_string(length));
  return length;
}

int make_bezier(lua_State* L) {
  const Fields fields(L, 1, bezier_signature);
  fields.require("points");
  fields.push("points");
  BezierGrid grid;
  const std::size_t rows = length_of_border(L, "bezier: points");
  for (std::size_t row = 0; row < rows; ++row, lua_pop(L, 1)) {
    const std::string what = "bezier: points: row " + std::to_string(row + 1);
    lua_rawgeti(L, -1, static_cast<lua_Integer>(row + 1));
    const std::size_t columns = length_of_border(L, what);
    if (row > 0 && columns != grid.width())
      throw SceneError(what + " has " + std::to_string(columns) + " points, the first one has " +
                       std::to_string(grid.width()));
    grid.columns = static_cast<std::uint32_t>(columns / 3);
    if (grid.columns * (rows / 3) > max_patches)
      throw SceneError("bezier: has more than " + std::to_string(max_patches) + " patches");
    for (std::size_t column = 0; column < columns; ++column, lua_pop(L, 1)) {
      lua_rawgeti(L, -1, static_cast<lua_Integer>(column + 1));
      const glm::dvec3 p = vector_at(L, -1, what + ", point " + std::to_string(column + 1));
      grid.points.push_back({p.x, p.y, p.z});
    }
  }
  lua_pop(L, 1);
  grid.rows = static_cast<std::uint32_t>(rows / 3);
  return push_content(L, Bezier{run_of(L).assets.add(std::move(grid))});
}

}  // namespace

void open_assets(lua_State* L) {
  lua_register(L, "mesh", guarded<make_mesh>);
  lua_register(L, "bezier", guarded<make_bezier>);
  lua_register(L, "picture", guarded<make_picture>);
}

const std::vector<Signature>& asset_signatures() {
  static const std::vector<Signature> all{mesh_signature, bezier_signature, picture_signature};
  return all;
}

}  // namespace rayfarm
