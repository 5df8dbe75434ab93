#include "master/cli/picture_options.h"

#include <charconv>

#include "common/net/codec.h"
#include "master/cli/whole_number.h"

namespace rayfarm {
namespace {

/// "640x480". Throws SettingsError.
Size size_of(const std::string& text) {
  const SettingsError wrong("--size wants WIDTHxHEIGHT in pixels, as in 640x480, is " + text);
  Size size;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [after_width, width_error] = std::from_chars(begin, end, size.width);
  if (width_error != std::errc{} || after_width == end || *after_width != 'x') throw wrong;
  const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.height);
  if (height_error != std::errc{} || after_height != end) throw wrong;
  return size;
}

std::map<std::string, std::string> params_of(const std::vector<std::string>& texts) {
  std::map<std::string, std::string> params;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw SettingsError("-p wants key=value, as in -p depth=6, is " + text);
    params[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return params;
}

}  // namespace

void add_sample_options(CLI::App& command, PictureOptions& o) {
  command.add_option("SCENE", o.scene_file, "Scene script (Lua)")->required();
  command.add_option("--size", o.size, "Width and height in pixels, e.g. 640x480");
  command.add_option("--spp", o.spp, "Samples per pixel (default 16)");
  command.add_option("--sampler", o.sampler, "sobol (default), jitter, regular, random or adapt1");
  command.add_option("--seed", o.seed, "Seed of the random numbers (default 0)")->check(whole_number());
  command.add_option("--depth", o.max_depth,
                     "Deepest recursion of reflected and refracted rays (default 12)");
  command.add_option("--min-importance", o.min_importance,
                     "Rays of less importance are not traced (default 0.05)");
  command.add_flag("--no-shadows", o.no_shadows, "All lights shine through everything");
  command.add_flag("--no-reflections", o.no_reflections, "No reflected rays");
  command.add_flag("--no-refractions", o.no_refractions, "No refracted rays");
  command.add_option("-p,--param", o.params, "A parameter of the script, key=value; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--frame", o.frame, "Frame of an animation, from 0");
}

void add_picture_options(CLI::App& command, PictureOptions& o) {
  add_sample_options(command, o);
  command
      .add_option("-o,--output", o.output,
                  "Picture to write, .exr (linear float) or .png (8 bit); #### is the frame's number")
      ->required();
  command
      .add_option(
          "--frames", o.frames,
          "Frames of an animation, A-B or A-B:step; -o then says where their numbers go, name.####.png")
      ->excludes("--frame");
  command.add_flag("--srgb", o.srgb, "PNG with the sRGB curve instead of gamma 2.2");
}

RenderSettings settings_of(const PictureOptions& o, const ImageDefaults& scene) {
  RenderSettings s;
  s.width = scene.width.value_or(s.width);
  s.height = scene.height.value_or(s.height);
  if (o.size) {
    const Size size = size_of(*o.size);
    s.width = size.width, s.height = size.height;
  }
  s.spp = o.spp.value_or(scene.spp.value_or(s.spp));
  if (o.sampler) {
    const std::optional<SamplerKind> sampler = sampler_named(*o.sampler);
    if (!sampler) throw SettingsError("--sampler must be " + sampler_names() + ", is " + *o.sampler);
    s.sampler = *sampler;
  }
  s.seed = o.seed.value_or(s.seed);
  s.frame = o.frame.value_or(s.frame);
  s.max_depth = o.max_depth.value_or(s.max_depth);
  s.min_importance = o.min_importance.value_or(s.min_importance);
  s.shadows = !o.no_shadows, s.reflections = !o.no_reflections, s.refractions = !o.no_refractions;
  leave_out(s, scene);
  check(s);
  return s;
}

ScriptRequest script_of(const PictureOptions& options) {
  return read_script(options.scene_file, params_of(options.params));
}

PreparedScene prepared(ScriptResult result, const RenderSettings& settings) {
  PreparedScene prepared;
  prepared.scene = std::move(result.scene), prepared.assets = std::move(result.assets);
  prepared.settings = settings;
  prepared.bytes = encode_scene(prepared.scene);
  prepared.hash = sha256_hex(prepared.bytes);
  return prepared;
}

PreparedScene prepare(const PictureOptions& options) {
  settings_of(options, {});  // a mistake in the options is told before the script runs
  ScriptRequest script = script_of(options);
  script.frame = options.frame.value_or(0);
  ScriptResult result = evaluate(script);
  const RenderSettings settings = settings_of(options, result.scene.image);
  return prepared(std::move(result), settings);
}

}  // namespace rayfarm
