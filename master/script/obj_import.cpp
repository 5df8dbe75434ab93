// OBJ files: tinyobjloader reads them, once it is known that it can. It has no word for a number that is none (it takes
// 0) nor for an index that is too large, so the lines are looked through before.
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <streambuf>

#include "common/scene/scene.h"
#include "master/script/mesh_import.h"

namespace rayfarm {
namespace {

constexpr std::string_view blanks = " \t";  // tinyobjloader knows no others

/// Takes the next word of a line; empty at its end.
std::string_view next_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(blanks), line.size());
  const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

class ObjCheck {
 public:
  explicit ObjCheck(const std::string& name) : name_(name) {}

  void look_through(std::string_view text) {
    while (!text.empty()) {
      ++line_number_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      look_at(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    for (const Largest* largest : {&points_, &texture_, &normals_})
      if (largest->named > largest->count) {
        line_number_ = largest->line;
        fail("names " + std::string(largest->what) + " " + std::to_string(largest->named) +
             ", but the file has " + std::to_string(largest->count));
      }
  }

 private:
  /// What faces name by number: how many there are, and the largest number named.
  struct Largest {
    const char* what;
    std::int64_t count = 0, named = 0;
    std::size_t line = 0;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(name_ + ":" + std::to_string(line_number_) + ": " + what);
  }

  void look_at(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    // Where tinyobjloader took some of them for the end of a line, or not for a blank, it would see other faces.
    const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\t'; };
    if (std::ranges::any_of(line, is_control)) fail("is no text");
    const std::string_view keyword = next_word(line);
    if (keyword == "v") {
      expect_numbers(line, 3, "a point"), ++points_.count;
    } else if (keyword == "vn") {
      expect_numbers(line, 3, "a normal"), ++normals_.count;
    } else if (keyword == "vt") {
      expect_numbers(line, 2, "a pair of texture coordinates"), ++texture_.count;
    } else if (keyword == "f") {
      expect_face(line);
    }
  }

  void expect_numbers(std::string_view line, int count, const std::string& what) const {
    for (int i = 0; i < count; ++i) {
      std::string_view word = next_word(line);
      if (word.starts_with('+')) word.remove_prefix(1);
      double x = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
      if (word.empty()) fail(what + " needs " + std::to_string(count) + " numbers, has " + std::to_string(i));
      if (end != word.data() + word.size() || error != std::errc{} || !std::isfinite(x))
        fail("\"" + std::string(word.substr(0, 40)) + "\" is no finite number");
    }
  }

  void expect_face(std::string_view line) {
    int corners = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++corners) {
      if (word.starts_with('#')) break;
      std::size_t field = 0;
      for (Largest* largest : {&points_, &texture_, &normals_}) {
        const std::size_t slash = std::min(word.find('/', field), word.size());
        const std::string_view number = word.substr(field, slash - field);
        if (!number.empty() || largest == &points_) expect_index(number, *largest);
        if (slash == word.size()) break;
        field = slash + 1;
      }
    }
    if (corners < 3) fail("a face needs 3 corners, has " + std::to_string(corners));
    if (corners > 255) fail("a face has more than 255 corners");  // tinyobjloader counts them in a byte
  }

  void expect_index(std::string_view text, Largest& largest) const {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (end != text.data() + text.size() || error != std::errc{} || index == 0)
      fail("\"" + std::string(text.substr(0, 40)) + "\" is no number of " + largest.what);
    if (index < -largest.count)
      fail("names " + std::string(largest.what) + " " + std::to_string(index) + ", but there are only " +
           std::to_string(largest.count) + " before");
    if (index > largest.named) largest.named = index, largest.line = line_number_;
  }

  const std::string& name_;
  std::size_t line_number_ = 0;
  Largest points_{"point"}, texture_{"texture coordinates"}, normals_{"normal"};
};

/// Bytes as a stream, without a copy.
class ViewBuffer : public std::streambuf {
 public:
  explicit ViewBuffer(std::string_view bytes) {
    char* begin = const_cast<char*>(bytes.data());  // streambuf has no other; it only reads
    setg(begin, begin, begin + bytes.size());
  }
};

std::uint32_t index_of(int index) {
  return index < 0 ? PolygonMesh::none : static_cast<std::uint32_t>(index);
}

}  // namespace

PolygonMesh read_obj(const std::string& name, std::string_view bytes) {
  if (constexpr std::string_view mark = "\xEF\xBB\xBF"; bytes.starts_with(mark))
    bytes.remove_prefix(mark.size());
  ObjCheck(name).look_through(bytes);
  ViewBuffer buffer(bytes);
  std::istream stream(&buffer);
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  constexpr bool cut_polygons = false, invent_colors = false;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, nullptr, cut_polygons,
                        invent_colors))
    throw SceneError(name + ": " + error.substr(0, error.find('\n')));

  PolygonMesh mesh;
  const auto triples = [](const std::vector<double>& numbers) {
    std::vector<Vec3d> vectors;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
      vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    return vectors;
  };
  mesh.points = triples(attributes.vertices), mesh.normals = triples(attributes.normals);
  mesh.texture = std::move(attributes.texcoords);
  for (const tinyobj::shape_t& shape : shapes) {
    for (const tinyobj::index_t& i : shape.mesh.indices)
      mesh.corners.push_back(
          {index_of(i.vertex_index), index_of(i.normal_index), index_of(i.texcoord_index)});
    for (const std::uint32_t corners : shape.mesh.num_face_vertices)
      mesh.face_ends.push_back((mesh.face_ends.empty() ? 0 : mesh.face_ends.back()) + corners);
  }
  return mesh;
}

}  // namespace rayfarm
