#include "master/cli/picture_options.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

TEST(PictureOptions, TheCommandLineStandsAboveTheSceneAndThatAboveTheDefaults) {
  const ImageDefaults scene{.width = 100, .height = 50, .spp = 4};
  EXPECT_EQ(settings_of({}, {}), RenderSettings{});
  EXPECT_EQ(settings_of({}, scene).width, 100u);
  EXPECT_EQ(settings_of({}, scene).spp, 4u);
  PictureOptions typed;
  typed.size = "7x8", typed.spp = 9;
  EXPECT_EQ(settings_of(typed, scene).width, 7u);
  EXPECT_EQ(settings_of(typed, scene).height, 8u);
  EXPECT_EQ(settings_of(typed, scene).spp, 9u);
}

TEST(PictureOptions, AnEffectIsThereIfNeitherTheSceneNorTheCommandLineLeavesItOut) {
  PictureOptions typed;
  typed.no_shadows = true;
  ImageDefaults scene;
  scene.refractions = false;
  const RenderSettings s = settings_of(typed, scene);
  EXPECT_FALSE(s.shadows);
  EXPECT_TRUE(s.reflections);
  EXPECT_FALSE(s.refractions);
}

TEST(PictureOptions, EachOptionSetsItsSetting) {
  PictureOptions typed;
  typed.sampler = "jitter", typed.seed = ~std::uint64_t{0}, typed.max_depth = 3, typed.frame = 7;
  typed.min_importance = 0.5, typed.no_shadows = typed.no_reflections = typed.no_refractions = true;
  RenderSettings expected;
  expected.sampler = SamplerKind::jitter, expected.seed = ~std::uint64_t{0}, expected.max_depth = 3;
  expected.frame = 7, expected.min_importance = 0.5;
  expected.shadows = expected.reflections = expected.refractions = false;
  EXPECT_EQ(settings_of(typed, {}), expected);
}

TEST(PictureOptions, ASizeIsTwoNumbersWithAnX) {
  for (const char* size : {"", "x", "640", "640x", "x480", "640x480x", "640X480", "-1x5", "640 x480",
                           "99999999999x1", "0x0", "0x480", "60001x1", "60000x60000", "1e3x5"}) {
    PictureOptions typed;
    typed.size = size;
    EXPECT_THROW(settings_of(typed, {}), SettingsError) << size;
  }
}

TEST(PictureOptions, WhatCannotBeRenderedIsNamed) {
  PictureOptions typed;
  typed.sampler = "adapt2";
  EXPECT_THROW(settings_of(typed, {}), SettingsError);
  typed.sampler = "regular", typed.spp = 10;
  EXPECT_THROW(settings_of(typed, {}), SettingsError);
}

}  // namespace
}  // namespace rayfarm
