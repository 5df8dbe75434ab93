// The module rayfarm-images: pictures to and from file bytes by OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <memory>

#include "master/files/image_module.h"

namespace rayfarm {
namespace {

OIIO::ImageSpec spec_of(const Picture& picture, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(static_cast<int>(picture.size.width), static_cast<int>(picture.size.height), 3, type);
  spec.channelnames = {"R", "G", "B"};
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

FileBytes exr(const Picture& picture) {
  OIIO::ImageSpec spec = spec_of(picture, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  // Without a DateTime OpenImageIO puts in the time of writing, which would make each file another one. One
  // of a type that EXR headers cannot hold leaves the entry out.
  const long long no_time = 0;
  spec.attribute("DateTime", OIIO::TypeDesc::INT64, &no_time);
  return encoded(".exr", spec, picture.rgb.data());
}

FileBytes png(const Picture& picture, std::span<const std::uint8_t> bytes, PngCurve curve) {
  OIIO::ImageSpec spec = spec_of(picture, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", curve == PngCurve::srgb ? "sRGB" : "Gamma2.2");
  if (curve == PngCurve::gamma22) spec.attribute("oiio:Gamma", 2.2f);
  return encoded(".png", spec, bytes.data());
}

/// R, G and B by name (a file may hold them in any order, with others between); a single channel is grey.
std::vector<float> rgb_of(const std::vector<float>& values, const OIIO::ImageSpec& spec,
                          const std::string& name) {
  const int channels = spec.nchannels;
  std::array<int, 3> index{spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  if (channels <= 2) index = {0, 0, 0};
  if (index[0] < 0 || index[1] < 0 || index[2] < 0) throw FileError(name + " has no channels R, G and B");
  const std::size_t pixels = values.size() / static_cast<std::size_t>(channels);
  std::vector<float> rgb(pixels * 3);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      rgb[3 * i + c] = values[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(index[c])];
  return rgb;
}

Picture read(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(name);
  if (!in) throw FileError("cannot read " + name + ": " + OIIO::geterror());
  const OIIO::ImageSpec spec = in->spec();
  if (static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height) > 500'000'000u)
    throw FileError(name + " has over 500 megapixels");
  std::vector<float> values(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(spec.nchannels));
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()))
    throw FileError("cannot read " + name + ": " + in->geterror());

  Picture picture;
  picture.size = {static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height)};
  picture.rgb = rgb_of(values, spec, name);
  for (const auto& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      picture.facts[attribute.name().string()] = attribute.get_string();
  return picture;
}

}  // namespace
}  // namespace rayfarm

extern "C" const rayfarm::ImageModule* rayfarm_images() {
  OIIO::attribute("debug", 0);  // its notes about the DateTime above would go to the user's terminal
  static const rayfarm::ImageModule module{rayfarm::exr, rayfarm::png, rayfarm::read};
  return &module;
}
