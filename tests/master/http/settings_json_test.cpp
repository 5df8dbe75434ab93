#include "master/http/settings_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace rayfarm {
namespace {

using nlohmann::json;

TEST(SettingsJson, ReadsBackWhatItWrote) {
  RenderSettings settings;
  settings.width = 17, settings.height = 60'000, settings.spp = 25, settings.sampler = SamplerKind::jitter;
  settings.seed = std::numeric_limits<std::uint64_t>::max();
  settings.frame = 7, settings.max_depth = 0, settings.min_importance = 0.1;
  settings.shadows = false, settings.reflections = false, settings.refractions = false;
  EXPECT_EQ(settings_from_json(json::parse(to_json(settings).dump())), settings);
  EXPECT_EQ(settings_from_json(json::object()), RenderSettings{});
}

std::string complaint_about(const char* text) {
  try {
    settings_from_json(json::parse(text));
  } catch (const SettingsError& error) {
    return error.what();
  }
  return "";
}

TEST(SettingsJson, KnowsEverySampler) {
  for (int kind = 0; kind <= static_cast<int>(last_sampler); ++kind) {
    RenderSettings settings;
    settings.sampler = static_cast<SamplerKind>(kind);
    EXPECT_EQ(settings_from_json(to_json(settings)), settings) << name_of(settings.sampler);
    EXPECT_NE(complaint_about(R"({"sampler": "best"})").find(name_of(settings.sampler)), std::string::npos);
  }
}

TEST(CountersJson, TellsWhatWasCountedAndWhatFollowsFromIt) {
  RayCounters c;
  c.primary = 100, c.reflected = 20, c.refracted = 3, c.shadow = 50, c.primary_hits = 60,
  c.secondary_hits = 7;
  c.bad_samples = 2, c.lost = 1;
  const json counters = to_json(c);
  EXPECT_EQ(counters["rays"], 173);
  EXPECT_EQ(counters["misses"], 56);
  EXPECT_EQ(counters["lost"], 1);
  EXPECT_EQ(counters["bad_samples"], 2);
}

TEST(SettingsJson, NamesWhatItRefuses) {
  EXPECT_NE(complaint_about(R"({"widht": 3})").find("widht"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"width": "3"})").find("width"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"width": -3})").find("width"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"width": 3.5})").find("width"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"width": 4294967297})").find("width"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"width": 0})"), "");
  EXPECT_NE(complaint_about(R"({"spp": 0})"), "");
  EXPECT_NE(complaint_about(R"({"sampler": "adapt2"})").find("sampler"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"sampler": 1})").find("sampler"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"shadows": 1})").find("shadows"), std::string::npos);
  EXPECT_NE(complaint_about(R"({"min_importance": null})").find("min_importance"), std::string::npos);
  EXPECT_NE(complaint_about("[]"), "");
}

}  // namespace
}  // namespace rayfarm
