// Meshes, Bezier surfaces and images as bytes.
#include <gtest/gtest.h>

#include "common/net/codec.h"
#include "tests/common/net/largest_allocation.h"
#include "tests/support/surfaces.h"

namespace rayfarm {
namespace {

std::vector<AssetContent> contents() {
  TriangleMesh mesh = ball_mesh(4, 6);
  mesh.normals = {{0, 0, 1}}, mesh.normals_at.assign(mesh.triangles.size(), {0, 0, 0});
  mesh.texture = {0.25, 0.5}, mesh.texture_at = mesh.normals_at;
  return {mesh, ball_grid(), Image{2, 1, std::vector<std::uint8_t>{0, 1, 2, 253, 254, 255}},
          Image{1, 2, std::vector<float>{0, 0.5f, 7, 1, 2, 3}}};
}

TEST(AssetCodec, DecodesToWhatWasEncoded) {
  for (const AssetContent& content : contents()) {
    const AssetData data = asset_data(content);
    const Asset asset = decode_asset(data);
    EXPECT_EQ(*asset.content(), content);
    EXPECT_EQ(asset.digest(), data.hash);
    EXPECT_EQ(asset_data(content).hash, data.hash);
  }
}

TEST(AssetCodec, RefusesBytesOfAnotherHashAndDamagedOnes) {
  const AssetData data = asset_data(ball_grid());
  AssetData other = data;
  other.hash[0] = other.hash[0] == '0' ? '1' : '0';
  EXPECT_THROW(decode_asset(other), CodecError);
  take_largest_allocation();
  for (std::size_t size = 0; size < data.bytes->size(); size += 5) {
    const auto cut = std::make_shared<const Bytes>(data.bytes->begin(),
                                                   data.bytes->begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(decode_asset({sha256_hex(*cut), cut}), CodecError) << size;
  }
  EXPECT_LT(take_largest_allocation(), 4u << 20);
}

TEST(AssetCodec, RefusesWhatCannotBeUsed) {
  TriangleMesh mesh = ball_mesh(4, 5);
  mesh.triangles[0][0] = 1000;
  EXPECT_THROW(decode_asset(asset_data(mesh)), CodecError);
  mesh = ball_mesh(4, 5);
  mesh.points[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(decode_asset(asset_data(mesh)), CodecError);
  EXPECT_THROW(decode_asset(asset_data(Image{2, 2, std::vector<std::uint8_t>(3)})), CodecError);
  EXPECT_THROW(decode_asset(asset_data(BezierGrid{1, 1, {{0, 0, 0}}})), CodecError);
}

TEST(AssetCodec, AScenesBytesNameItsAssetsOnly) {
  const Asset ball = decode_asset(asset_data(ball_mesh(20, 30)));
  Scene scene;
  scene.nodes.push_back({Solid{Mesh{0, true}}, {}, {}, {}, {}, ""});
  scene.assets = {ball};
  const Bytes bytes = encode_scene(scene);
  EXPECT_LT(bytes.size(), 1000u);
  EXPECT_EQ(decode_scene(bytes, std::vector{ball}), scene);
  EXPECT_THROW(decode_scene(bytes), CodecError);
}

}  // namespace
}  // namespace rayfarm
