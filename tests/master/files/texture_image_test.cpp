// Textures out of the bytes of image files, also of those that claim more than they hold.
#include "master/files/texture_image.h"

#include <gtest/gtest.h>

#include <string>

#include "common/scene/scene.h"

namespace rayfarm {
namespace {

/// The head of a Radiance picture of this size, and one pixel of it.
std::string claiming(std::uint32_t width, std::uint32_t height) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n\x80\x40\x20\x81";
}

std::string complaint(std::uint32_t width, std::uint32_t height) {
  try {
    read_texture_image("a.hdr", claiming(width, height));
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

TEST(TextureImage, WhatItClaimsToBeIsTakenWhenItIs) {
  EXPECT_EQ(std::get<std::vector<float>>(read_texture_image("a.hdr", claiming(1, 1)).values),
            (std::vector<float>{1, 0.5f, 0.25f}));
}

TEST(TextureImage, ALargeClaimIsRefusedBeforeItCostsMemory) {
  EXPECT_EQ(complaint(30'000'000, 2), "a.hdr has a side of more than 65536 pixels");
  EXPECT_EQ(complaint(1, 65'537), "a.hdr has a side of more than 65536 pixels");
  EXPECT_EQ(complaint(30'000, 3'000), "a.hdr has more than 64 megapixels");
  EXPECT_TRUE(complaint(300, 200).starts_with("a.hdr is no whole image")) << complaint(300, 200);
}

}  // namespace
}  // namespace rayfarm
