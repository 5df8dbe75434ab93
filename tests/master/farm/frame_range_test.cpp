// Ranges of frames, as people write them.
#include "master/frame_range.h"

#include <gtest/gtest.h>

#include "common/render/settings.h"

namespace rayfarm {
namespace {

TEST(FrameRange, IsWrittenAsFirstLastAndStep) {
  EXPECT_EQ(parse_frame_range("7"), (FrameRange{7, 7, 1}));
  EXPECT_EQ(parse_frame_range("0-499"), (FrameRange{0, 499, 1}));
  EXPECT_EQ(parse_frame_range("10-20:5"), (FrameRange{10, 20, 5}));
  EXPECT_EQ(parse_frame_range("10-10:5"), (FrameRange{10, 10, 5}));
}

TEST(FrameRange, EndsWithAFrameThatItHas) {
  EXPECT_EQ(parse_frame_range("0-10:4"), (FrameRange{0, 8, 4}));
  EXPECT_EQ(parse_frame_range("0-10:4").count(), 3u);
}

TEST(FrameRange, PlacesAndFramesAreInverses) {
  for (const FrameRange range : {FrameRange{0, 0, 1}, FrameRange{5, 25, 4}, FrameRange{0, 499, 1}}) {
    for (std::uint32_t place = 0; place < range.count(); ++place)
      EXPECT_EQ(range.index_of(range.at(place)), place);
    EXPECT_EQ(range.at(range.count() - 1), range.last);
    EXPECT_EQ(range.index_of(range.last + 1), std::nullopt);
  }
  EXPECT_EQ((FrameRange{5, 25, 4}.index_of(6)), std::nullopt);
  EXPECT_EQ((FrameRange{5, 25, 4}.index_of(4)), std::nullopt);
}

TEST(FrameRange, IsReadAsItIsWritten) {
  for (const char* text : {"7", "0-499", "10-20:5"}) EXPECT_EQ(text_of(parse_frame_range(text)), text);
}

TEST(FrameRange, WhatCannotBeIsRefused) {
  for (const char* text : {"", "-", "a", "1-", "-3", "1-2:", "1-2:0", "5-3", "1-2-3", "1:2:3", "1.5", " 1",
                           "1-2 ", "0-4294967296", "0-99999", "0x10"})
    EXPECT_THROW(parse_frame_range(text), SettingsError) << text;
  EXPECT_EQ(parse_frame_range("0-99999:10").count(), 10'000u);
  EXPECT_EQ(parse_frame_range("4294967295").last, 4294967295u);
}

}  // namespace
}  // namespace rayfarm
