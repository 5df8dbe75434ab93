#include "master/files/image_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "common/math/deterministic.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

Picture noise(Size size) {
  Picture picture{size, {}, {{"rayfarm:seed", "18446744073709551615"}, {"rayfarm:version", "0.1.0"}}};
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(-0.5f, 3.0f);
  for (std::size_t i = 0; i < std::size_t{3} * size.width * size.height; ++i)
    picture.rgb.push_back(value(random));
  return picture;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(ExrFile, ReadsBackBitForBitWithItsFacts) {
  const ScratchFolder folder;
  Picture picture = noise({67, 41});
  picture.rgb[0] = std::numeric_limits<float>::infinity();
  picture.rgb[1] = -0.0f;
  picture.rgb[2] = std::numeric_limits<float>::denorm_min();
  write_picture(folder / "a.exr", picture);
  const Picture back = read_picture(folder / "a.exr");
  EXPECT_EQ(back.size, picture.size);
  EXPECT_TRUE(same_bits(back.rgb, picture.rgb));
  for (const auto& [name, value] : picture.facts) EXPECT_EQ(back.facts.at(name), value);
}

// OpenImageIO puts the time of writing into each EXR header unless it is kept from it; two writes in one
// second would not show that.
TEST(ExrFile, HoldsNoTimeAndNoHost) {
  const ScratchFolder folder;
  write_picture(folder / "a.exr", noise({67, 41}));
  const std::string bytes = content_of(folder / "a.exr");
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  EXPECT_EQ(bytes.find("capDate"), std::string::npos);
  EXPECT_EQ(bytes.find("DateTime"), std::string::npos);
  EXPECT_EQ(bytes.find(host), std::string::npos);
  EXPECT_EQ(bytes.find(folder.path().string()), std::string::npos);
}

TEST(ExrFile, HoldsNamedChannelsBesideThePictureOrAlone) {
  const ScratchFolder folder;
  Picture picture = noise({9, 5});
  const std::vector<float> before = picture.rgb;
  std::vector<float> depth(45), normals = noise({9, 5}).rgb;
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = static_cast<float>(i);
  depth[7] = std::numeric_limits<float>::infinity();
  picture.groups = {{{"Z"}, depth}, {{"N.X", "N.Y", "N.Z"}, normals}};
  write_picture(folder / "both.exr", picture);
  picture.rgb.clear();
  write_picture(folder / "alone.exr", picture);

  EXPECT_TRUE(same_bits(read_picture(folder / "both.exr").rgb, before));
  for (const std::string name : {"both.exr", "alone.exr"}) {
    EXPECT_TRUE(same_bits(read_channels(folder / name, {"Z"}).values, depth));
    EXPECT_TRUE(same_bits(read_channels(folder / name, {"N.X", "N.Y", "N.Z"}).values, normals));
    EXPECT_THROW(read_channels(folder / name, {"Samples"}), FileError);
  }
}

TEST(PictureFile, TheSamePixelsAndFactsGiveTheSameBytesUnderAnyName) {
  const ScratchFolder folder;
  for (const std::string ending : {".exr", ".png"}) {
    write_picture(folder / ("a" + ending), noise({67, 41}));
    write_picture(folder / ("another name" + ending), noise({67, 41}));
    EXPECT_EQ(content_of(folder / ("a" + ending)), content_of(folder / ("another name" + ending)));
  }
}

TEST(PngFile, ValuesAreClampedGammaEncodedAndRounded) {
  const ScratchFolder folder;
  const Picture picture = noise({16, 16});
  write_picture(folder / "a.png", picture);
  const Picture back = read_picture(folder / "a.png");
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    const double v = std::fmin(std::fmax(picture.rgb[i], 0), 1);
    EXPECT_EQ(std::lround(255 * back.rgb[i]), std::lround(255 * deterministic::pow(v, 1 / 2.2)))
        << picture.rgb[i];
  }
}

TEST(PngFile, NotANumberIsBlackAndInfinityIsWhite) {
  const ScratchFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  write_picture(folder / "a.png", {{1, 1}, {std::nanf(""), infinity, -infinity}, {}});
  EXPECT_EQ(read_picture(folder / "a.png").rgb, (std::vector<float>{0, 1, 0}));
}

TEST(PngFile, ReadLinearUndoesBothCurves) {
  const ScratchFolder folder;
  const Picture grey{{1, 1}, {0.2f, 0.5f, 0.001f}, {}};
  for (const PngCurve curve : {PngCurve::gamma22, PngCurve::srgb}) {
    write_picture(folder / "a.png", grey, curve);
    const Picture back = read_linear(folder / "a.png");
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(back.rgb[i], grey.rgb[i], 0.006);  // half a step of 8 bits
  }
}

TEST(PngFile, BytesForTheWebPageAreThoseOfTheFile) {
  const ScratchFolder folder;
  write_picture(folder / "a.png", noise({9, 5}));
  const std::vector<std::uint8_t> bytes = png_bytes(noise({9, 5}));
  EXPECT_EQ(content_of(folder / "a.png"), std::string(bytes.begin(), bytes.end()));
}

std::string complaint_about(const std::filesystem::path& file) {
  try {
    check_writable(file);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckWritable, NamesWhatIsInTheWayAndChangesNothing) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "folder.exr");
  EXPECT_NE(complaint_about(folder / "a.jpg").find(".exr or .png"), std::string::npos);
  EXPECT_NE(complaint_about(folder / "a").find(".exr or .png"), std::string::npos);
  EXPECT_NE(complaint_about(folder / "missing/a.exr").find("does not exist"), std::string::npos);
  EXPECT_NE(complaint_about(folder / "folder.exr").find("is a folder"), std::string::npos);
  EXPECT_NE(complaint_about(folder / (std::string(300, 'a') + ".exr")), "");
  EXPECT_EQ(complaint_about(folder / "a.exr"), "");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(CheckWritable, LeavesAnOldFileAsItWas) {
  const ScratchFolder folder;
  put_content(folder / "a.exr", "old");
  EXPECT_EQ(complaint_about(folder / "a.exr"), "");
  EXPECT_EQ(content_of(folder / "a.exr"), "old");
}

TEST(CheckWritable, RefusesWhereTheUserMayNotWrite) {
  const ScratchFolder folder;
  const auto nobody_writes = std::filesystem::perms::all &
                             ~(std::filesystem::perms::owner_write | std::filesystem::perms::group_write |
                               std::filesystem::perms::others_write);
  std::filesystem::permissions(folder.path(), nobody_writes);
  constexpr uid_t nobody = 65534;
  const bool is_root = ::geteuid() == 0;  // who may write everywhere
  ASSERT_TRUE(!is_root || ::seteuid(nobody) == 0);
  const std::string complaint = complaint_about(folder / "a.exr");
  ASSERT_TRUE(!is_root || ::seteuid(0) == 0);
  EXPECT_NE(complaint.find("no file can be made"), std::string::npos);
}

TEST(ReadPicture, SaysWhatIsWrong) {
  const ScratchFolder folder;
  put_content(folder / "broken.exr", "this is no picture");
  put_content(folder / "broken.png", "");
  EXPECT_THROW(read_picture(folder / "none.exr"), FileError);
  EXPECT_THROW(read_picture(folder / "broken.exr"), FileError);
  EXPECT_THROW(read_picture(folder / "broken.png"), FileError);
}

}  // namespace
}  // namespace rayfarm
