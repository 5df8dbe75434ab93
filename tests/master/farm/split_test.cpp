// Tiles in pieces: how they are cut, put together again, and which are worth it.
#include "master/split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/simple_job.h"

namespace rayfarm {
namespace {

constexpr std::array<Size, 4> films{Size{64, 64}, Size{64, 17}, Size{1, 1}, Size{100, 45}};

TEST(Pieces, AreDisjointAndCoverTheirTile) {
  for (const Size film : films)
    for (const std::uint32_t count : {1u, 4u, 16u})
      for (std::uint32_t number = 0; number < tile_count(film); ++number) {
        const Tile tile = tile_at(film, number);
        const std::vector<Tile> pieces = pieces_of(tile, count);
        EXPECT_LE(pieces.size(), count);
        std::vector<int> covered(tile_side * tile_side);
        for (const Tile& piece : pieces) {
          EXPECT_TRUE(is_piece(piece, tile));
          for (std::uint32_t y = piece.y0; y < piece.y1; ++y)
            for (std::uint32_t x = piece.x0; x < piece.x1; ++x)
              ++covered[(y - tile.y0) * tile_side + (x - tile.x0)];
        }
        for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
          for (std::uint32_t x = tile.x0; x < tile.x1; ++x)
            EXPECT_EQ(covered[(y - tile.y0) * tile_side + (x - tile.x0)], 1) << x << ", " << y;
      }
}

TEST(Pieces, PutTogetherAreTheWholeTile) {
  const auto never = [] { return false; };
  for (const Size film : films)
    for (const std::uint32_t count : {4u, 16u})
      for (PassSet passes = 1; passes <= all_passes; ++passes) {
        const RenderSettings settings{.width = film.width, .height = film.height, .spp = 3};
        const std::uint32_t last = tile_count(film) - 1;
        const Tile tile = tile_at(film, last);
        const std::vector<Tile> pieces = pieces_of(tile, count);
        std::vector<std::vector<PassImage>> images;
        for (const Tile& piece : pieces) images.push_back(*position_area(settings, piece, passes, never));
        EXPECT_EQ(assembled(tile, pieces, images), *position_tile(settings, last, passes, never));
      }
}

TEST(Pieces, AreNoMoreThanHelp) {
  const auto rounds = [](std::size_t tiles, std::uint32_t pieces, std::uint32_t threads) {
    return std::ceil(static_cast<double>(tiles * pieces) / threads) / pieces;
  };
  for (std::size_t tiles = 1; tiles < 40; ++tiles)
    for (std::uint32_t threads = 1; threads < 40; ++threads) {
      const std::uint32_t chosen = pieces_each(tiles, threads);
      for (const std::uint32_t other : {1u, 4u, 16u}) {
        EXPECT_LE(rounds(tiles, chosen, threads), rounds(tiles, other, threads));
        if (other < chosen) {
          EXPECT_LT(rounds(tiles, chosen, threads), rounds(tiles, other, threads));
        }
      }
    }
  EXPECT_EQ(pieces_each(4, 4), 1u);
  EXPECT_EQ(pieces_each(1, 4), 4u);
  EXPECT_EQ(pieces_each(1, 8), 16u);
}

constexpr double long_ago = 1;  // seconds

TEST(Shares, ATileThatIsBegunIsSharedByThoseWhoAreSoonerTogether) {
  const std::vector<Straggler> half_done{{1, 0.5, 100, long_ago}};  // 100 rays at 100 a second
  EXPECT_TRUE(shares_of(half_done, std::vector<IdleWorker>{{2, 100, 2}}).empty()) << "no sooner";
  EXPECT_EQ(shares_of(half_done, std::vector<IdleWorker>{{2, 100, 4}}), (std::vector<Share>{{0, 4}}));
  EXPECT_EQ(shares_of(half_done, std::vector<IdleWorker>{{2, 100, 2}, {3, 100, 2}}),
            (std::vector<Share>{{0, 4}}));
  EXPECT_EQ(shares_of(half_done, std::vector<IdleWorker>{{2, 100, 8}}), (std::vector<Share>{{0, 16}}));
}

TEST(Shares, OneThreadAloneSharesNothing) {
  const std::vector<Straggler> slow{{1, 50, 100, long_ago}, {1, 60, 100, {}}};
  EXPECT_TRUE(shares_of(slow, std::vector<IdleWorker>{{2, 100, 1}}).empty()) << "it takes one whole";
}

TEST(Shares, HolderHelpsWithWhatItHasHardlyBegun) {
  const std::vector<Straggler> all(4, {1, 1, 100, 0.0});
  EXPECT_EQ(shares_of(all, std::vector<IdleWorker>{{2, 100, 4}}).size(), 4u) << "eight threads, four tiles";
}

TEST(Shares, WhatEndsLastIsSharedFirst) {
  const std::vector<Straggler> all{{1, 1, 100, long_ago}, {1, 3, 100, long_ago}, {1, 2, 100, long_ago}};
  const std::vector<Share> shares = shares_of(all, std::vector<IdleWorker>{{2, 100, 4}});
  ASSERT_FALSE(shares.empty());
  EXPECT_EQ(shares[0].straggler, 1u);
}

TEST(Shares, WhatIsSoonDoneIsNotSplit) {
  EXPECT_TRUE(
      shares_of(std::vector<Straggler>{{1, 1, 1, long_ago}}, std::vector<IdleWorker>{{2, 100, 8}}).empty())
      << "a hundredth of a second";
  EXPECT_EQ(shares_of(std::vector<Straggler>{{1, 1, 4, long_ago}}, std::vector<IdleWorker>{{2, 100, 8}}),
            (std::vector<Share>{{0, 4}}))
      << "pieces of a hundredth";
}

TEST(Shares, AreDoneBeforeTheHoldersWouldBe) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> some(0.1, 10);
  for (int round = 0; round < 300; ++round) {
    std::vector<Straggler> stragglers;
    for (unsigned i = 0; i < random() % 10; ++i)
      stragglers.push_back({1, some(random), some(random), long_ago});
    std::vector<IdleWorker> idle;
    double speed = 0;
    for (unsigned i = 0; i < random() % 5; ++i) {
      idle.push_back({2 + i, some(random), static_cast<std::uint32_t>(1 + random() % 4)});
      speed += idle.back().threads * idle.back().speed;
    }
    double ahead = 0;
    for (const Share& share : shares_of(stragglers, idle)) {
      ahead += stragglers[share.straggler].cost;
      EXPECT_LE(ahead / speed, stragglers[share.straggler].time_left * 1.000001);
    }
  }
}

}  // namespace
}  // namespace rayfarm
