#include "master/files/image_file.h"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "common/math/deterministic.h"
#include "master/files/atomic_write.h"
#include "master/files/ending.h"
#include "master/files/image_module.h"

namespace rayfarm {
namespace {

enum class FileKind { exr, png };

FileKind kind_of(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  if (ending == ".exr") return FileKind::exr;
  if (ending == ".png") return FileKind::png;
  throw FileError("cannot tell the kind of picture from the name " + file.string() +
                  "; let it end in .exr or .png");
}

void check_readable(const std::filesystem::path& file) {
  kind_of(file);
  if (!std::filesystem::exists(file)) throw FileError("there is no file " + file.string());
}

double encoded(double linear, PngCurve curve) {
  if (curve == PngCurve::gamma22) return deterministic::pow(linear, 1 / 2.2);
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * deterministic::pow(linear, 1 / 2.4) - 0.055;
}

double decoded(double stored, PngCurve curve) {
  if (curve == PngCurve::gamma22) return deterministic::pow(stored, 2.2);
  return stored <= 0.04045 ? stored / 12.92 : deterministic::pow((stored + 0.055) / 1.055, 2.4);
}

/// 0..255, rounded; what is below 0 or not a number is 0.
std::uint8_t byte_of(float linear, PngCurve curve) {
  if (!(linear > 0)) return 0;
  return static_cast<std::uint8_t>(std::floor(255 * encoded(std::min(1.0, double{linear}), curve) + 0.5));
}

}  // namespace

void check_writable(const std::filesystem::path& file) {
  kind_of(file);
  check_place(file);
}

void check_cloud_place(const std::filesystem::path& file) {
  if (ending_of(file) != ".ply")
    throw FileError("a cloud is a .ply; let its name end in .ply, is " + file.string());
  check_place(file);
}

void check_place(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status))
    throw FileError(file.string() + " is a folder; name a file to write");
  if (!std::filesystem::is_directory(folder))
    throw FileError("the folder " + folder.string() + " does not exist; make it first, or write elsewhere");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw FileError(file.string() + " is not a regular file; name another");
  if (error && status.type() == std::filesystem::file_type::none)
    throw FileError("cannot write " + file.string() + ": " + error.message());
  if (::euidaccess(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError("no file can be made in the folder " + folder.string() + ": " + std::strerror(errno));
  if (std::filesystem::exists(status) && ::euidaccess(file.c_str(), W_OK) != 0)
    throw FileError("cannot replace " + file.string() + ": " + std::strerror(errno));
}

std::vector<std::uint8_t> png_bytes(const Picture& picture, PngCurve curve) {
  assert(picture.rgb.size() == std::size_t{3} * picture.size.width * picture.size.height);
  std::vector<std::uint8_t> bytes(picture.rgb.size());
  std::transform(picture.rgb.begin(), picture.rgb.end(), bytes.begin(),
                 [&](float value) { return byte_of(value, curve); });
  return image_module().png(picture, bytes, curve);
}

std::vector<std::uint8_t> exr_bytes(const Picture& picture) { return image_module().exr(picture); }

void write_picture(const std::filesystem::path& file, const Picture& picture, PngCurve curve) {
  check_writable(file);
  write_atomically(file, kind_of(file) == FileKind::exr ? exr_bytes(picture) : png_bytes(picture, curve));
}

Picture read_picture(const std::filesystem::path& file) {
  check_readable(file);
  return image_module().read(file);
}

ChannelGroup read_channels(const std::filesystem::path& file, const std::vector<std::string>& names) {
  check_readable(file);
  return image_module().channels(file, names);
}

Picture read_linear(const std::filesystem::path& file) {
  Picture picture = read_picture(file);
  if (kind_of(file) == FileKind::exr) return picture;
  const PngCurve curve = picture.facts["oiio:ColorSpace"] == "Gamma2.2" ? PngCurve::gamma22 : PngCurve::srgb;
  for (float& value : picture.rgb) value = static_cast<float>(decoded(value, curve));
  return picture;
}

}  // namespace rayfarm
