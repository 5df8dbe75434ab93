#include "master/files/ply.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

namespace rayfarm {
namespace {

constexpr std::array<std::string_view, 3> form_names{"binary", "ascii", "compact"};

/// 0..65534, so that 0 and both ends are exact.
constexpr double octahedral_half = 32767;

double sign_of(double v) { return v < 0 ? -1 : 1; }

template <class Number>
void append_number(Number number, std::vector<std::uint8_t>& bytes) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(number);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// A point in memory is as in the file, but for what stands after its colour.
void append_binary(std::span<const PlyPoint> points, std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t size = 27;
  static_assert(offsetof(PlyPoint, normal) == 12 && offsetof(PlyPoint, color) == 24);
  static_assert(std::endian::native == std::endian::little);
  const std::size_t before = bytes.size();
  bytes.resize(before + size * points.size());
  std::uint8_t* into = bytes.data() + before;
  for (const PlyPoint& p : points) std::memcpy(std::exchange(into, into + size), &p, size);
}

void append_compact(const PlyPoint& p, std::vector<std::uint8_t>& bytes) {
  for (const float v : p.position) append_number(v, bytes);
  for (const std::uint16_t v : octahedral(p.normal)) append_number(v, bytes);
  bytes.insert(bytes.end(), p.color.begin(), p.color.end());
}

template <class Number>
void append_text(Number number, char after, std::vector<std::uint8_t>& bytes) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  bytes.insert(bytes.end(), text.data(), end);
  bytes.push_back(static_cast<std::uint8_t>(after));
}

void append_line(const PlyPoint& p, std::vector<std::uint8_t>& bytes) {
  for (const float v : p.position) append_text(v, ' ', bytes);
  for (const float v : p.normal) append_text(v, ' ', bytes);
  append_text(unsigned{p.color[0]}, ' ', bytes);
  append_text(unsigned{p.color[1]}, ' ', bytes);
  append_text(unsigned{p.color[2]}, '\n', bytes);
}

}  // namespace

std::optional<PlyForm> ply_form_named(std::string_view name) {
  for (std::size_t i = 0; i < form_names.size(); ++i)
    if (form_names[i] == name) return static_cast<PlyForm>(i);
  return std::nullopt;
}

std::string ply_header(PlyForm form, std::uint64_t points) {
  const std::string count = std::to_string(points);
  std::string text = "ply\nformat ";
  text += form == PlyForm::ascii ? "ascii" : "binary_little_endian";
  text += " 1.0\ncomment rayfarm " RAYFARM_VERSION "\ncomment " + std::string(20 - count.size(), '.') +
          "\nelement vertex " + count + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (form == PlyForm::compact)
    text +=
        "comment normal: u = nu / 32767 - 1, v = nv / 32767 - 1, z = 1 - |u| - |v|;\n"
        "comment if z < 0: (u, v) = ((1 - |v|) * sign(u), (1 - |u|) * sign(v)); (u, v, z) normalised\n"
        "property ushort nu\nproperty ushort nv\n";
  else
    text += "property float nx\nproperty float ny\nproperty float nz\n";
  return text + "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
}

void append_ply(PlyForm form, std::span<const PlyPoint> points, std::vector<std::uint8_t>& bytes) {
  switch (form) {
    case PlyForm::binary:
      return append_binary(points, bytes);
    case PlyForm::ascii:
      for (const PlyPoint& p : points) append_line(p, bytes);
      return;
    case PlyForm::compact:
      for (const PlyPoint& p : points) append_compact(p, bytes);
      return;
  }
}

Octahedral octahedral(const std::array<float, 3>& n) {
  const double size = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
  double u = n[0] / size, v = n[1] / size;
  if (n[2] < 0) {
    const double folded = (1 - std::fabs(v)) * sign_of(u);
    v = (1 - std::fabs(u)) * sign_of(v), u = folded;
  }
  const auto whole = [](double share) {
    return static_cast<std::uint16_t>(std::floor((share + 1) * octahedral_half + 0.5));
  };
  return {whole(u), whole(v)};
}

std::array<float, 3> unit_of(const Octahedral& place) {
  double u = place[0] / octahedral_half - 1, v = place[1] / octahedral_half - 1;
  const double z = 1 - std::fabs(u) - std::fabs(v);
  if (z < 0) {
    const double folded = (1 - std::fabs(v)) * sign_of(u);
    v = (1 - std::fabs(u)) * sign_of(v), u = folded;
  }
  const double length = std::sqrt(u * u + v * v + z * z);
  return {static_cast<float>(u / length), static_cast<float>(v / length), static_cast<float>(z / length)};
}

}  // namespace rayfarm
