// Where a frame's number goes in the name of its file.
#include "master/cli/frame_files.h"

#include <gtest/gtest.h>

#include "common/render/settings.h"

namespace rayfarm {
namespace {

TEST(FrameFiles, TheNumberTakesThePlaceOfTheLastRunOfNumberSigns) {
  EXPECT_EQ(frame_file("name.####.png", 7), "name.0007.png");
  EXPECT_EQ(frame_file("####.png", 7), "0007.png");
  EXPECT_EQ(frame_file("#", 0), "0");
  EXPECT_EQ(frame_file("a/b##/shot#2.###.exr", 12), "a/b##/shot#2.012.exr");
  EXPECT_EQ(frame_file("name.##.png", 12345), "name.12345.png");
}

TEST(FrameFiles, ANameWithoutAPlaceStaysAsItIs) {
  for (const char* file : {"name.png", "folder##/name.png", ""}) {
    EXPECT_EQ(frame_file(file, 7), file);
    EXPECT_FALSE(has_place_for_frame(file));
    EXPECT_THROW(expect_place_for_frame("-o", file), SettingsError);
  }
  EXPECT_NO_THROW(expect_place_for_frame("-o", "name.####.png"));
}

TEST(FrameFiles, TheComplaintSaysWhatToWrite) {
  try {
    expect_place_for_frame("-o", "out/name.png");
    ADD_FAILURE();
  } catch (const SettingsError& error) {
    EXPECT_NE(std::string(error.what()).find("out/name.####.png"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace rayfarm
