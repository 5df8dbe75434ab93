#include "common/net/codec.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <iterator>

#include "common/net/compress.h"
#include "common/net/text.h"
#include "tests/common/net/largest_allocation.h"
#include "tests/common/net/random_messages.h"

namespace rayfarm {
namespace {

TEST(SceneCodec, DecodesToTheSceneThatWasEncoded) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 300; ++round) {
    const Scene scene = named_scene(random);
    EXPECT_EQ(decode_scene(encode_scene(scene)), scene);
  }
}

TEST(SceneCodec, GivesTheSameBytesForTheSameScene) {
  std::mt19937_64 random(2);
  const Scene scene = named_scene(random);
  EXPECT_EQ(encode_scene(scene), encode_scene(Scene(scene)));
}

TEST(SceneCodec, NeverMistakesADamagedSceneForAnother) {
  std::mt19937_64 random(3);
  const Scene scene = named_scene(random);
  const Bytes bytes = encode_scene(scene);
  take_largest_allocation();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(decode_scene(ByteView(bytes).first(size)), CodecError);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= 1 << bit % 8;
    try {
      EXPECT_EQ(decode_scene(flipped), scene);  // zstd has bits that mean nothing
    } catch (const CodecError&) {
    } catch (const SceneError&) {}
  }
  EXPECT_LT(take_largest_allocation(), 4u << 20);
}

TEST(SceneCodec, RefusesAnotherSceneBehindTheFirst) {
  std::mt19937_64 random(4);
  Bytes bytes = encode_scene(named_scene(random));
  const Bytes first = bytes;
  bytes.insert(bytes.end(), first.begin(), first.end());
  EXPECT_THROW(decode_scene(bytes), CodecError);
}

TEST(SceneCodec, ChecksWhatItDecodes) {
  Scene scene;
  scene.nodes.push_back({Torus{-1, 1}, {}, {}, {}, {}, ""});
  EXPECT_THROW(decode_scene(encode_scene(scene)), SceneError);
}

/// One node of each kind, but for those that came at the end of a list of kinds: they leave the others' bytes alone.
Scene scene_of_many_kinds(const Camera& camera) {
  Scene scene;
  scene.camera = camera;
  const auto add = [&](const NodeContent& content) -> Node& {
    scene.nodes.emplace_back().content = content;
    return scene.nodes.back();
  };
  add(Operation{CsgOp::unite, 10});
  for (const Solid& solid : std::vector<Solid>{Sphere{}, Cube{}, Plane{}, Cylinder{-1, 2}, Torus{2, 0.5},
                                               Cone{-1, 2}, Mesh{0, false}, Bezier{1}})
    add(solid);
  add(Glow{Cylinder{-1, 2}, {1, 2, 3}, 4});
  Node& dressed = add(Glow{Sphere{}, {1, 2, 3}, 4});
  dressed.parent_from_node = {{1, 2, 3, 4, 5, 6, 7, 8, 9}, {10, 11, 12}};
  dressed.material = 0, dressed.color = glm::dvec3(1, 2, 3), dressed.name = "a", dressed.no_shadow = true;
  dressed.textures = {Checker{1, 2, {3, 4, 5}}, Stripes{1, 2, {3, 4, 5}}, ImageTexture{2, 3, 4, false}};
  scene.materials.emplace_back();
  scene.assets = {Asset("a"), Asset("b"), Asset("c")};
  scene.lights = {AmbientLight{{1, 2, 3}}, PointLight{{1, 2, 3}, {4, 5, 6}}, RectangleLight{}};
  scene.image = {1, 2, 3, false, true, false};
  scene.animation = Animation{1, 2, 3};
  scene.nested_media = true;
  return scene;
}

// Who reads bytes that have changed under the same number reads another scene out of them. When this fails, raise
// scene_format in scene_codec.cpp, and only then the digest here.
TEST(SceneCodec, TheFormatsNumberChangesWithTheBytes) {
  Bytes all;
  for (const Camera& camera :
       std::vector<Camera>{PerspectiveCamera{}, FisheyeCamera{}, ParabolicCamera{}, OrthographicCamera{}}) {
    const Bytes compressed = encode_scene(scene_of_many_kinds(camera));
    DecompressedSource source(compressed, 1u << 20);
    all.insert(all.end(), std::istreambuf_iterator<char>(&source), {});
  }
  EXPECT_EQ("format " + std::to_string(all[0]) + ", digest " + sha256_hex(all),
            "format 3, digest 98618ab672d9b46550f972c0bffc96e92fa4553d7bc274b686a9ad3c5a32ef7e");
}

template <class Floats>
bool same_bits(const Floats& a, const Floats& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

Film random_film(std::mt19937_64& random, Size size) {
  Film film(size);
  for (std::uint32_t number = 0; number < tile_count(size); ++number)
    for (int pass = 0; pass < pass_count; ++pass) {
      if (random() % 3 == 0) continue;
      PassImage image = random_pass(random, pass);
      image.rgb.resize(3 * pixel_count(tile_at(size, number), pass));
      film.put(number, image);
    }
  return film;
}

TEST(FilmCodec, KeepsEveryBitOfEveryPassThatIsThere) {
  std::mt19937_64 random(5);
  for (const Size size : {Size{1, 1}, Size{64, 64}, Size{200, 70}, Size{129, 300}}) {
    const Film film = random_film(random, size);
    const Film decoded = decode_film(encode_film(film));
    EXPECT_EQ(decoded.size(), size);
    EXPECT_TRUE(same_bits(decoded.rgb(), film.rgb()));
    for (std::uint32_t number = 0; number < tile_count(size); ++number)
      EXPECT_EQ(decoded.passes_of(number), film.passes_of(number));
  }
}

TEST(FilmCodec, RefusesAFilmThatIsCutAnywhere) {
  std::mt19937_64 random(6);
  const Bytes bytes = encode_film(random_film(random, {70, 5}));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(decode_film(ByteView(bytes).first(size)), CodecError);
}

TEST(FilmCodec, DoesNotBelieveAnAnnouncedSize) {
  take_largest_allocation();
  EXPECT_THROW(decode_film(Bytes{0, 0x40, 0, 0, 0, 0x40, 0, 0, 0}),
               CodecError);  // 16384 x 16384, one byte of it
  EXPECT_THROW(decode_film(Bytes{255, 255, 255, 255, 1, 0, 0, 0, 0}), CodecError);
  EXPECT_LT(take_largest_allocation(), 1u << 20);
}

TEST(FilmCodec, WithFlippedBitsIsRefusedOrAFilm) {
  std::mt19937_64 random(7);
  const Bytes bytes = encode_film(random_film(random, {20, 9}));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= 1 << bit % 8;
    try {
      decode_film(flipped);
    } catch (const CodecError&) {}
  }
}

TEST(Digest, IsTheKnownSha256) {
  EXPECT_EQ(sha256_hex({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex(Bytes{'a', 'b', 'c'}),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Base64, DecodesToWhatWasEncodedAndTakesNothingElse) {
  std::mt19937_64 random(8);
  for (std::size_t size = 0; size < 100; ++size) {
    Bytes bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(from_base64(base64(bytes)), bytes);
  }
  EXPECT_EQ(base64(Bytes{'f', 'o', 'o', 'b'}), "Zm9vYg==");
  for (const char* bad : {"Zm9vYg=", "Zm9vYh==", "Zm 9", "====", "Zg=a", " Zm9", "Zm9v\n"})
    EXPECT_THROW(from_base64(bad), CodecError) << bad;
}

TEST(PlainText, IsALineOfShortestUtf8WithoutControlCharacters) {
  for (const char* good : {"", "abc def", "Žluťoučký kůň", "日本", "😀"})
    EXPECT_TRUE(is_plain_text(good)) << good;
  for (const char* bad : {"\x1b[31m", "abc\ndef", "abc\tdef", "abc\u2028def", "\xC0\x80", "\xE0\x80\x80",
                          "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xC3", "\x80", "\xC2\x85", "\x7f"})
    EXPECT_FALSE(is_plain_text(bad)) << bad;
}

}  // namespace
}  // namespace rayfarm
