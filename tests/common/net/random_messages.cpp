#include "tests/common/net/random_messages.h"

#include <bit>

#include "tests/support/random_scene.h"
#include "tests/support/surfaces.h"

namespace rayfarm {
namespace {

std::string random_name(std::mt19937_64& random) { return "Müllers PC " + std::to_string(random() % 1000); }

std::vector<LeaseId> random_leases(std::mt19937_64& random) {
  std::vector<LeaseId> leases(random() % 20);
  for (LeaseId& lease : leases) lease = LeaseId{random()};
  return leases;
}

Assignment random_assignment(std::mt19937_64& random) {
  return {LeaseId{random()}, JobId{random()}, static_cast<std::uint32_t>(random()),
          static_cast<std::uint32_t>(random()), static_cast<PassSet>(1 + random() % 15)};
}

Tile random_piece(std::mt19937_64& random) {
  const auto x0 = static_cast<std::uint32_t>(random() % 60'000),
             y0 = static_cast<std::uint32_t>(random() % 60'000);
  return {x0, y0, x0 + 1 + static_cast<std::uint32_t>(random() % 64),
          y0 + 1 + static_cast<std::uint32_t>(random() % 64)};
}

RenderSettings random_settings(std::mt19937_64& random) {
  RenderSettings s;
  s.width = 1 + random() % 2000, s.height = 1 + random() % 2000, s.spp = 16;
  s.sampler = static_cast<SamplerKind>(random() % 5);
  s.seed = random(), s.frame = random() % 100, s.max_depth = random() % 20;
  s.shadows = random() % 2, s.reflections = random() % 2, s.refractions = random() % 2;
  return s;
}

}  // namespace

Scene named_scene(std::mt19937_64& random) {
  Scene scene = random() % 2 ? random_scene(random()) : random_special_scene(random());
  for (Node& node : scene.nodes)
    if (random() % 2) node.name = random_name(random);
  if (random() % 2)
    scene.image = {random() % 1000 + 1, std::nullopt, 16, random() % 2 == 0, true, random() % 2 == 0};
  scene.nested_media = random() % 2;
  if (random() % 2) scene.animation = Animation{0, 20, 25};
  return scene;
}

PassImage random_pass(std::mt19937_64& random, int pass) {
  PassImage image;
  image.pass = pass;
  image.rgb.resize(3 * pixel_count({0, 0, tile_side, tile_side}, pass));
  for (float& value : image.rgb) value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
  image.counters = {random(), random(), random(), random(), random(), random(), random(), random()};
  return image;
}

std::vector<ToWorker> random_to_worker(std::mt19937_64& random) {
  const Bytes scene = encode_scene(named_scene(random));
  const std::string hash = sha256_hex(scene);
  return {Welcome{random_name(random), {4, 4, random()}},
          Refused{"the name " + random_name(random) + " is banned"},
          SceneData{hash, std::make_shared<const Bytes>(scene)},
          FrameStart{JobId{random()}, hash, random_settings(random), {hash, std::string(64, 'b')}},
          random_assignment(random),
          PieceAssignment{random_assignment(random), random_piece(random)},
          Revoke{random_leases(random)},
          Unneeded{random_leases(random)},
          FrameEnd{JobId{random()}, static_cast<std::uint32_t>(random())},
          Heartbeat{},
          Goodbye{"the master stops"},
          asset_data(ball_mesh(4, 5)),
          AssetEnd{{hash, std::string(64, 'c')}},
          Paired{Bytes(random() % 2000, 'p')}};
}

std::vector<ToMaster> random_to_master(std::mt19937_64& random) {
  Result result{LeaseId{random()},
                JobId{random()},
                static_cast<std::uint32_t>(random()),
                static_cast<std::uint32_t>(random()),
                {},
                0.25};
  for (int pass = 0; pass < pass_count; ++pass)
    if (pass == 3 || random() % 2) result.images.push_back(random_pass(random, pass));
  return {Hello{{4, 4, random()},
                "0.1.0",
                random_name(random),
                "Some CPU",
                static_cast<std::uint32_t>(random()),
                std::string(64, 'e'),
                random()},
          result,
          PieceResult{result, random_piece(random)},
          GiveBack{random_leases(random), "it stops"},
          Holds{{{random_assignment(random), true}, {random_assignment(random), false}}},
          Heartbeat{},
          Goodbye{"the worker stops"},
          Join{{4, 4, random()},
               "0.1.0",
               "0123456789abcdef01234567",
               random_name(random),
               Bytes(random() % 2000, 'r')}};
}

}  // namespace rayfarm
