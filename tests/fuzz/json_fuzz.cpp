// JSON that people's programs send, and that the master keeps; the first byte says which.
//
// Law: settings and credentials that were read are written to what is read as the same.
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "master/access/credentials_json.h"
#include "master/http/live/json.h"
#include "master/http/script_submission.h"
#include "master/http/settings_json.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

void submit(const std::string& text) try {
  AssetStore store;
  submitted_job(parse_json(text), SceneLibrary("/nowhere"), store);
} catch (const std::exception&) {  // of many kinds: api.cpp makes answers of them
}

void read_frame(const std::string& text) try {
  AssetStore store;
  const SubmittedFrame frame = frame_from_json(parse_json(text), store);
  require(frame_from_json(to_json(frame), store).scene.hash == frame.scene.hash,
          "a frame sent on is the same");
} catch (const std::exception&) {}

void read_settings(const std::string& text) try {
  const RenderSettings settings = settings_from_json(parse_json(text));
  require(settings_from_json(to_json(settings)) == settings, "settings that were sent on are the same");
} catch (const ApiError&) {
} catch (const SettingsError&) {}

void watch(const std::string& text) try { layers_to_watch(text); } catch (const ApiError&) {
}

void read_credentials(const std::string& text) {
  std::string once;
  try {
    once = json_of(credentials_in(text));
  } catch (const std::runtime_error&) {
    return;
  }
  require(json_of(credentials_in(once)) == once, "credentials that are kept are the same");
}

}  // namespace

void fuzz(ByteView bytes) {
  constexpr void (*readers[])(const std::string&) = {submit, read_frame, read_settings, watch,
                                                     read_credentials};
  const std::uint8_t which = take_byte(bytes) % std::size(readers);
  readers[which](std::string(text_of(bytes)));
}

}  // namespace rayfarm
