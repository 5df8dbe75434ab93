// Pictures on disk: EXR (linear float32) and PNG (8 bit), by OpenImageIO.
//
// Whole files are a function of the pixels and the given facts alone: no time stamps, no host names.
// A file is written beside its target and renamed, so a failed write leaves the old one as it was.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/render/tile.h"

namespace rayfarm {

struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Values of an EXR beside the picture's, or instead of them.
struct ChannelGroup {
  std::vector<std::string> names;  // "N.X", "N.Y", "N.Z"
  std::vector<float> values;       // row-major, names.size() a pixel
};

struct Picture {
  Size size;
  std::vector<float> rgb;                    // row-major, linear Rec. 709; may be empty in an EXR with groups
  std::map<std::string, std::string> facts;  // "rayfarm:seed" -> "0" ..., into the header
  std::vector<ChannelGroup> groups{};        // into an EXR alone
};

enum class PngCurve : std::uint8_t { gamma22, srgb };

/// Throws FileError unless a file can be made there. Changes nothing.
void check_place(const std::filesystem::path& file);
/// The same, and unless the name ends in .exr or .png; in .ply.
void check_writable(const std::filesystem::path& file);
void check_cloud_place(const std::filesystem::path& file);
void write_picture(const std::filesystem::path& file, const Picture& picture,
                   PngCurve curve = PngCurve::gamma22);
/// The bytes of a file, for those who send it.
std::vector<std::uint8_t> exr_bytes(const Picture& picture);
std::vector<std::uint8_t> png_bytes(const Picture& picture, PngCurve curve = PngCurve::gamma22);
/// EXR as stored; PNG values 0..1 as stored (not linearised). A file of one channel is grey, one of three of
/// any names is taken as red, green and blue.
Picture read_picture(const std::filesystem::path& file);
/// Channels by name, as stored. Throws FileError when one is not there.
ChannelGroup read_channels(const std::filesystem::path& file, const std::vector<std::string>& names);
/// As read_picture, with a PNG's curve undone: ours as its header says, others as sRGB.
Picture read_linear(const std::filesystem::path& file);

}  // namespace rayfarm
