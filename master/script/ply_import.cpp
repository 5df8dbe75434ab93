// PLY files: ascii and binary of both byte orders. Source: G. Turk, The PLY Polygon File Format, 1994.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "common/scene/scene.h"
#include "master/script/mesh_import.h"

namespace rayfarm {
namespace {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_named(std::string_view name) {
  struct Named {
    std::string_view name, other_name;
  };
  constexpr std::array<Named, 8> names{{{"char", "int8"},
                                        {"uchar", "uint8"},
                                        {"short", "int16"},
                                        {"ushort", "uint16"},
                                        {"int", "int32"},
                                        {"uint", "uint32"},
                                        {"float", "float32"},
                                        {"double", "float64"}}};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i].name || name == names[i].other_name) return static_cast<Type>(i);
  return std::nullopt;
}

constexpr std::array<std::size_t, 8> bytes_of_type{1, 1, 2, 2, 4, 4, 4, 8};
std::size_t bytes_of(Type type) { return bytes_of_type[static_cast<std::size_t>(type)]; }

struct Property {
  std::string name;
  Type type{};
  std::optional<Type> count_type;  // of a list
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
enum class Format : std::uint8_t { ascii, little_endian, big_endian };
struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
};

/// The file from front to back.
class PlySource {
 public:
  PlySource(const std::string& name, std::string_view bytes)
      : name_(name), rest_(bytes), size_(bytes.size()) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(name_ +
                     (is_text_ ? ":" + std::to_string(line_) + ": "
                               : ": at byte " + std::to_string(size_ - rest_.size()) + ": ") +
                     what);
  }

  void begin_data(Format format) { format_ = format, is_text_ = format == Format::ascii; }
  std::size_t bytes_left() const { return rest_.size(); }

  std::string_view line() {
    if (rest_.empty()) fail("the file ends too early");
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  double number(Type type) { return is_text_ ? text_number() : binary_number(type); }

  /// A number of things, or the place of one.
  std::uint64_t count(Type type, const std::string& what) {
    const double x = number(type);
    if (!(x >= 0 && x <= 4294967295.0 && x == std::floor(x))) fail(what + " must be a whole number");
    return static_cast<std::uint64_t>(x);
  }

 private:
  double text_number() {
    std::size_t begin = 0;
    for (; begin < rest_.size() && std::strchr(" \t\r\n", rest_[begin]); ++begin)
      line_ += rest_[begin] == '\n';
    rest_.remove_prefix(begin);
    if (rest_.empty()) fail("the file ends too early");
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    std::string_view word = rest_.substr(0, end);
    if (word.starts_with('+')) word.remove_prefix(1);
    double x = 0;
    const auto [after, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (after != word.data() + word.size() || error != std::errc{})
      fail("\"" + std::string(word.substr(0, 40)) + "\" is no number");
    rest_.remove_prefix(end);
    return x;
  }

  double binary_number(Type type) {
    const std::size_t size = bytes_of(type);
    if (rest_.size() < size) fail("the file ends too early");
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from_low = format_ == Format::little_endian ? i : size - 1 - i;
      bits |= std::uint64_t{static_cast<unsigned char>(rest_[i])} << (8 * from_low);
    }
    rest_.remove_prefix(size);
    switch (type) {
      case Type::int8:
        return static_cast<std::int8_t>(bits);
      case Type::int16:
        return static_cast<std::int16_t>(bits);
      case Type::int32:
        return static_cast<std::int32_t>(bits);
      case Type::float32:
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      case Type::float64:
        return std::bit_cast<double>(bits);
      default:
        return static_cast<double>(bits);
    }
  }

  const std::string& name_;
  std::string_view rest_;
  std::size_t size_, line_ = 1;
  Format format_ = Format::ascii;
  bool is_text_ = true;
};

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t at = line.find_first_not_of(" \t"); at < line.size();
       at = line.find_first_not_of(" \t", at)) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.emplace_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

Format format_of(const std::vector<std::string>& words, const PlySource& source) {
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return Format::ascii;
    if (words[1] == "binary_little_endian") return Format::little_endian;
    if (words[1] == "binary_big_endian") return Format::big_endian;
  }
  source.fail("the format must be ascii, binary_little_endian or binary_big_endian, version 1.0");
}

Element element_of(const std::vector<std::string>& words, const PlySource& source) {
  Element element;
  if (words.size() != 3) source.fail("an element needs a name and a count");
  element.name = words[1];
  const std::string& count = words[2];
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (end != count.data() + count.size() || error != std::errc{})
    source.fail("\"" + count.substr(0, 40) + "\" is no number of elements");
  return element;
}

Property property_of(const std::vector<std::string>& words, const PlySource& source) {
  const auto type = [&](const std::string& name) {
    const std::optional<Type> known = type_named(name);
    if (!known) source.fail("there is no type \"" + name.substr(0, 40) + "\"");
    return *known;
  };
  if (words.size() == 5 && words[1] == "list") return {words[4], type(words[3]), type(words[2])};
  if (words.size() == 3) return {words[2], type(words[1]), std::nullopt};
  source.fail("a property needs a type and a name, or list, two types and a name");
}

constexpr std::size_t most_declared = 200;  // elements, and properties of each

Header read_header(PlySource& source) {
  if (source.line() != "ply") source.fail("is no PLY file: its first line must be ply");
  Header header;
  bool has_format = false;
  for (;;) {
    const std::vector<std::string> words = words_of(source.line());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      header.format = format_of(words, source), has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(element_of(words, source));
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(property_of(words, source));
    } else {
      source.fail("\"" + words[0].substr(0, 40) + "\" has no place in the header");
    }
    if (header.elements.size() > most_declared ||
        (!header.elements.empty() && header.elements.back().properties.size() > most_declared))
      source.fail("more than " + std::to_string(most_declared) + " elements or properties");
  }
  if (!has_format) source.fail("the header does not say which format");
  return header;
}

/// The fewest bytes that an element can take.
std::size_t least_bytes(const Element& element, Format format) {
  std::size_t bytes = 0;
  for (const Property& p : element.properties)
    bytes += format == Format::ascii ? 2 : bytes_of(p.count_type.value_or(p.type));
  return bytes;
}

void check_counts(const Header& header, PlySource& source) {
  for (const Element& element : header.elements) {
    const std::size_t each = least_bytes(element, header.format),
                      room = source.bytes_left() + 1;  // the last line's end
    if (element.count > 0 && (each == 0 || element.count > room / each))
      source.fail("the header announces " + std::to_string(element.count) + " of " +
                  element.name.substr(0, 40) + ", but the file has room for at most " +
                  std::to_string(each == 0 ? 0 : room / each));
  }
}

/// The properties of a vertex by what they are for; an unknown one is skipped.
enum class Role : std::uint8_t { x, y, z, nx, ny, nz, u, v, none };

Role role_of(const Property& property) {
  constexpr std::array<std::pair<std::string_view, Role>, 12> roles{{{"x", Role::x},
                                                                     {"y", Role::y},
                                                                     {"z", Role::z},
                                                                     {"nx", Role::nx},
                                                                     {"ny", Role::ny},
                                                                     {"nz", Role::nz},
                                                                     {"u", Role::u},
                                                                     {"v", Role::v},
                                                                     {"s", Role::u},
                                                                     {"t", Role::v},
                                                                     {"texture_u", Role::u},
                                                                     {"texture_v", Role::v}}};
  if (property.count_type) return Role::none;
  for (const auto& [name, role] : roles)
    if (property.name == name) return role;
  return Role::none;
}

void skip(const Property& property, PlySource& source) {
  const std::uint64_t count = property.count_type ? source.count(*property.count_type, "a list's length") : 1;
  for (std::uint64_t i = 0; i < count; ++i) source.number(property.type);
}

void read_vertices(const Element& element, PlySource& source, PolygonMesh& mesh) {
  std::vector<Role> roles;
  std::array<bool, 9> has{};
  for (const Property& p : element.properties) {
    roles.push_back(role_of(p));
    has[static_cast<std::size_t>(roles.back())] = true;
  }
  const auto has_all = [&](Role first, Role last) {
    for (auto r = static_cast<std::size_t>(first); r <= static_cast<std::size_t>(last); ++r)
      if (!has[r]) return false;
    return true;
  };
  if (!has_all(Role::x, Role::z)) source.fail("a vertex needs the properties x, y and z");
  const bool with_normals = has_all(Role::nx, Role::nz), with_texture = has_all(Role::u, Role::v);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::array<double, 9> values{};
    for (std::size_t p = 0; p < roles.size(); ++p) {
      if (roles[p] == Role::none) {
        skip(element.properties[p], source);
        continue;
      }
      const double x = source.number(element.properties[p].type);
      if (!std::isfinite(x)) source.fail("a vertex has a number that is not finite");
      values[static_cast<std::size_t>(roles[p])] = x;
    }
    mesh.points.push_back({values[0], values[1], values[2]});
    if (with_normals) mesh.normals.push_back({values[3], values[4], values[5]});
    if (with_texture) mesh.texture.insert(mesh.texture.end(), {values[6], values[7]});
  }
}

void read_corners(const Property& property, PlySource& source, PolygonMesh& mesh) {
  const std::uint64_t corners = source.count(*property.count_type, "a face's number of corners");
  if (corners < 3) source.fail("a face needs 3 corners, has " + std::to_string(corners));
  for (std::uint64_t i = 0; i < corners; ++i) {
    const std::uint64_t point = source.count(property.type, "a face's vertex");
    if (point >= mesh.points.size())
      source.fail("a face names vertex " + std::to_string(point) + ", but the file has " +
                  std::to_string(mesh.points.size()) + ", counted from 0");
    const auto number = static_cast<std::uint32_t>(point);
    mesh.corners.push_back({number, mesh.normals.empty() ? PolygonMesh::none : number,
                            mesh.texture.empty() ? PolygonMesh::none : number});
  }
  mesh.face_ends.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

void read_faces(const Element& element, PlySource& source, PolygonMesh& mesh) {
  const auto is_corners = [](const Property& p) {
    return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  if (element.count > 0 && std::ranges::none_of(element.properties, is_corners))
    source.fail("a face needs the property list vertex_indices");
  if (element.count > 0 && mesh.points.empty())
    source.fail("the faces come before the vertices: write element vertex first");
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const Property& p : element.properties) {
      if (is_corners(p))
        read_corners(p, source, mesh);
      else
        skip(p, source);
    }
}

}  // namespace

PolygonMesh read_ply(const std::string& name, std::string_view bytes) {
  PlySource source(name, bytes);
  const Header header = read_header(source);
  check_counts(header, source);
  source.begin_data(header.format);
  PolygonMesh mesh;
  for (const Element& element : header.elements) {
    if (element.name == "vertex")
      read_vertices(element, source, mesh);
    else if (element.name == "face")
      read_faces(element, source, mesh);
    else
      for (std::uint64_t i = 0; i < element.count; ++i)
        for (const Property& p : element.properties) skip(p, source);
  }
  return mesh;
}

}  // namespace rayfarm
