// The module rayfarm-images: pictures to and from file bytes by OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <memory>

#include "master/files/image_module.h"

namespace rayfarm {
namespace {

OIIO::ImageSpec spec_of(const Picture& picture, const std::vector<std::string>& channels,
                        OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(static_cast<int>(picture.size.width), static_cast<int>(picture.size.height),
                       static_cast<int>(channels.size()), type);
  spec.channelnames = channels;
  for (const auto& [name, value] : picture.facts) spec.attribute(name, value);
  return spec;
}

/// The bytes of a whole file; `format` is its ending, e.g. ".exr".
FileBytes encoded(const std::string& format, const OIIO::ImageSpec& spec, const void* pixels) {
  FileBytes bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create("picture" + format);
  if (!out) throw FileError("OpenImageIO cannot write " + format + ": " + OIIO::geterror());
  if (!out->set_ioproxy(&memory) || !out->open("picture" + format, spec) ||
      !out->write_image(spec.format, pixels) || !out->close())
    throw FileError("cannot encode the picture as " + format + ": " + out->geterror());
  return bytes;
}

const std::vector<std::string> rgb_names{"R", "G", "B"};

/// Pixel by pixel the values of all groups.
std::vector<float> interleaved(const std::vector<ChannelGroup>& groups, std::size_t pixels) {
  std::size_t channels = 0;
  for (const ChannelGroup& group : groups) channels += group.names.size();
  std::vector<float> values(pixels * channels);
  std::size_t first = 0;
  for (const ChannelGroup& group : groups) {
    const std::size_t count = group.names.size();
    assert(group.values.size() == pixels * count);
    for (std::size_t i = 0; i < pixels; ++i)
      std::copy_n(&group.values[i * count], count, &values[i * channels + first]);
    first += count;
  }
  return values;
}

FileBytes exr(const Picture& picture) {
  const std::size_t pixels = std::size_t{picture.size.width} * picture.size.height;
  std::vector<ChannelGroup> groups = picture.groups;
  if (!picture.rgb.empty() && !groups.empty()) groups.insert(groups.begin(), {rgb_names, picture.rgb});
  std::vector<std::string> names;
  for (const ChannelGroup& group : groups) names.insert(names.end(), group.names.begin(), group.names.end());
  OIIO::ImageSpec spec = spec_of(picture, groups.empty() ? rgb_names : names, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  // Without a DateTime OpenImageIO puts in the time of writing, which would make each file another one. One
  // of a type that EXR headers cannot hold leaves the entry out.
  const long long no_time = 0;
  spec.attribute("DateTime", OIIO::TypeDesc::INT64, &no_time);
  if (groups.empty()) {
    assert(picture.rgb.size() == 3 * pixels);
    return encoded(".exr", spec, picture.rgb.data());
  }
  return encoded(".exr", spec, interleaved(groups, pixels).data());
}

FileBytes png(const Picture& picture, std::span<const std::uint8_t> bytes, PngCurve curve) {
  OIIO::ImageSpec spec = spec_of(picture, rgb_names, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", curve == PngCurve::srgb ? "sRGB" : "Gamma2.2");
  if (curve == PngCurve::gamma22) spec.attribute("oiio:Gamma", 2.2f);
  return encoded(".png", spec, bytes.data());
}

/// A file as stored.
struct StoredImage {
  OIIO::ImageSpec spec;
  std::vector<float> values;  // spec.nchannels a pixel

  Size size() const {
    return {static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height)};
  }
  std::vector<float> channels(const std::vector<int>& which) const {
    const auto stored = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> picked;
    picked.reserve(values.size() / stored * which.size());
    for (std::size_t pixel = 0; pixel < values.size(); pixel += stored)
      for (const int channel : which) picked.push_back(values[pixel + static_cast<std::size_t>(channel)]);
    return picked;
  }
};

StoredImage stored_image(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(name);
  if (!in) throw FileError("cannot read " + name + ": " + OIIO::geterror());
  StoredImage image{in->spec(), {}};
  const OIIO::ImageSpec& spec = image.spec;
  if (static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height) > 500'000'000u)
    throw FileError(name + " has over 500 megapixels");
  image.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                      static_cast<std::size_t>(spec.nchannels));
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()))
    throw FileError("cannot read " + name + ": " + in->geterror());
  return image;
}

/// A file may hold R, G and B in any order, with others between.
std::vector<int> rgb_channels(const OIIO::ImageSpec& spec, const std::string& name) {
  if (spec.nchannels <= 2) return {0, 0, 0};
  const std::vector<int> rgb{spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return rgb;
  if (spec.nchannels == 3) return {0, 1, 2};
  throw FileError(name + " has no channels R, G and B");
}

Picture read(const std::filesystem::path& file) {
  const StoredImage image = stored_image(file);
  Picture picture;
  picture.size = image.size();
  picture.rgb = image.channels(rgb_channels(image.spec, file.string()));
  for (const auto& attribute : image.spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      picture.facts[attribute.name().string()] = attribute.get_string();
  return picture;
}

ChannelGroup channels(const std::filesystem::path& file, const std::vector<std::string>& names) {
  const StoredImage image = stored_image(file);
  std::vector<int> which;
  for (const std::string& name : names) {
    which.push_back(image.spec.channelindex(name));
    if (which.back() < 0) throw FileError(file.string() + " has no channel " + name);
  }
  return {names, image.channels(which)};
}

// Textures. ------------------------------------------------------------------------------------------------

/// Red, green and blue of all pixels, in the type T.
template <class T>
std::vector<T> rgb_values(OIIO::ImageInput& in, const std::string& name) {
  const OIIO::ImageSpec spec = in.spec();
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t pixels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  std::vector<T> stored(pixels * channels);
  const OIIO::TypeDesc type = sizeof(T) == 1 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT;
  if (!in.read_image(0, 0, 0, spec.nchannels, type, stored.data()))
    throw FileError(name + " is no whole image: " + in.geterror());
  const std::vector<int> which =
      channels == 4 && spec.channelindex("R") < 0 ? std::vector{0, 1, 2} : rgb_channels(spec, name);
  std::vector<T> rgb;
  rgb.reserve(3 * pixels);
  for (std::size_t pixel = 0; pixel < stored.size(); pixel += channels)
    for (const int channel : which) rgb.push_back(stored[pixel + static_cast<std::size_t>(channel)]);
  return rgb;
}

constexpr std::size_t max_stored_values = 4 * max_image_pixels;

Image texture(const std::string& name, std::string_view bytes) {
  OIIO::attribute("threads", 1);  // the limited child may have no others
  OIIO::attribute("exr_threads", -1);
  OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());  // it only reads
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(name, nullptr, &memory);
  if (!in) throw FileError(name + " is no image that can be read: " + OIIO::geterror());
  const OIIO::ImageSpec spec = in->spec();
  const auto width = static_cast<std::uint32_t>(spec.width), height = static_cast<std::uint32_t>(spec.height);
  if (const std::string fault = fault_of_image_size(width, height); !fault.empty())
    throw FileError(name + " " + fault);
  if (spec.depth > 1 || spec.nchannels < 1 || spec.nchannels > 64 ||
      std::size_t{width} * height * static_cast<std::size_t>(spec.nchannels) > max_stored_values)
    throw FileError(name + " is no flat image of 1 to 64 channels with at most " +
                    std::to_string(max_stored_values >> 20) + " million values");

  Image image{width, height, {}};
  if (spec.format == OIIO::TypeDesc::UINT8) {
    image.values = rgb_values<std::uint8_t>(*in, name);
    return image;
  }
  std::vector<float> values = rgb_values<float>(*in, name);
  const std::string space =
      spec.get_string_attribute("oiio:ColorSpace", spec.format.is_floating_point() ? "Linear" : "sRGB");
  if (space != "Linear" && space != "linear" && space != "scene_linear")
    for (float& value : values) value = static_cast<float>(linear_of_srgb(value));
  image.values = std::move(values);
  return image;
}

}  // namespace
}  // namespace rayfarm

extern "C" const rayfarm::ImageModule* rayfarm_images() {
  OIIO::attribute("debug", 0);  // its notes about the DateTime above would go to the user's terminal
  static const rayfarm::ImageModule module{rayfarm::exr, rayfarm::png, rayfarm::read, rayfarm::channels,
                                           rayfarm::texture};
  return &module;
}
