// The options that say what picture is made: the same for all commands that render.
#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/net/messages.h"
#include "common/render/settings.h"
#include "master/files/image_file.h"
#include "master/script/script.h"

namespace rayfarm {

struct PictureOptions {
  std::string scene_file;
  std::string output;
  bool srgb = false;
  std::vector<std::string> params;  // key=value
  std::optional<std::string> size;  // WIDTHxHEIGHT
  std::optional<std::uint32_t> spp, max_depth, frame;
  std::optional<std::string> frames;  // A-B or A-B:step
  std::optional<std::string> sampler;
  std::optional<std::uint64_t> seed;
  std::optional<double> min_importance;
  bool no_shadows = false, no_reflections = false, no_refractions = false;

  PngCurve curve() const { return srgb ? PngCurve::srgb : PngCurve::gamma22; }
};

/// Scene, settings: what decides the samples.
void add_sample_options(CLI::App& command, PictureOptions& options);
/// The same and the picture to write, or those of several frames.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// The command line stands above what the scene asks for, that above the built-in defaults. Checked; throws
/// SettingsError.
RenderSettings settings_of(const PictureOptions& options, const ImageDefaults& scene);

/// A scene ready to render or to send.
struct PreparedScene {
  Scene scene;
  std::vector<std::uint8_t> bytes;  // encode_scene()
  std::string hash;                 // of the bytes
  std::vector<AssetData> assets;    // those of the scene
  RenderSettings settings;
};

/// The script and its parameters. Throws SceneError or SettingsError.
ScriptRequest script_of(const PictureOptions& options);
PreparedScene prepared(ScriptResult result, const RenderSettings& settings);
/// Evaluates the script. Throws SceneError or SettingsError.
PreparedScene prepare(const PictureOptions& options);

}  // namespace rayfarm
