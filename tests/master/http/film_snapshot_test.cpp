#include "master/http/film_snapshot.h"

#include <gtest/gtest.h>

#include "master/http/api_error.h"
#include "tests/support/farm_thread.h"
#include "tests/support/test_submission.h"

namespace rayfarm {
namespace {

class FilmSnapshot : public testing::Test {
 protected:
  JobId submit(std::uint32_t width, std::uint32_t height) {
    JobId id{};
    farm.run([&](Farm& f, FarmTime now) {
      JobSpec spec = small_job();
      spec.settings.width = width, spec.settings.height = height, spec.settings.spp = 1;
      id = f.submit(spec, now);
    });
    return id;
  }
  /// Once the farm's thread has nothing left to do.
  std::shared_ptr<const Film> film(JobId id) {
    std::shared_ptr<const Film> film;
    std::uint64_t pixels = 0, before = 1;
    for (; pixels != before; before = pixels, pixels = film ? film->pixels_done() : 0)
      farm.run([&](Farm& f, FarmTime) { film = f.film(id); });
    return film;
  }

  FarmThread farm{FarmLimits{.film_bytes = 100'000}};  // one small film
  FarmDoor door{[this](FarmThread::Task task) { farm.post(std::move(task)); }};
};

// 18 x 16 tiles: more than are copied at once.
TEST_F(FilmSnapshot, OfAGrowingFilmIsWhatIsThereAndStaysSo) {
  const JobId id = submit(1150, 1010);
  farm.add_renderer("pc1", 270);
  farm.add_renderer("pc2", 3);
  while (film(id)->pixels_done() < 270 * 50) std::this_thread::yield();
  std::shared_ptr<const Film> snapshot;
  do snapshot = film_snapshot(door, id, {});
  while (snapshot->pixels_done() != film(id)->pixels_done());
  EXPECT_FALSE(snapshot->is_complete());
  EXPECT_NE(snapshot, film(id));
  EXPECT_EQ(snapshot->filled(), film(id)->filled());
}

TEST_F(FilmSnapshot, OfACompleteFilmIsTheFilmItself) {
  const JobId id = submit(96, 80);
  farm.add_renderer("pc1");
  while (!film(id)->is_complete()) std::this_thread::yield();
  EXPECT_EQ(film_snapshot(door, id, {}), film(id));
}

TEST_F(FilmSnapshot, OfAnOldJobIsGone) {
  const JobId old = submit(96, 80), next = submit(96, 80);
  farm.add_renderer("pc1");
  while (!film(next) || !film(next)->is_complete()) std::this_thread::yield();
  try {
    film_snapshot(door, old, {});
    FAIL();
  } catch (const ApiError& error) {
    EXPECT_EQ(error.status, 410u);
    EXPECT_STREQ(error.what(), "the picture of job 1 is no longer kept; submit it again");
  }
}

TEST_F(FilmSnapshot, WithoutAFilmIsAnError) {
  EXPECT_THROW(film_snapshot(door, JobId{7}, {}), ApiError);
  EXPECT_THROW(film_snapshot(door, submit(96, 80), {}), ApiError);
}

/// A value of its own for each pixel.
void put_pass(Film& film, std::uint32_t tile, int pass) {
  PassImage image{pass, {}, {}};
  for_each_pixel(tile_at(film.size(), tile), pass, [&](std::uint32_t x, std::uint32_t y) {
    image.rgb.insert(image.rgb.end(), {static_cast<float>(x + 1), static_cast<float>(y + 1), 0});
  });
  film.put(tile, image);
}

// Tile n has the passes that n says, so all combinations are there.
TEST(Preview, OfALargePictureIsEachNthPixelOfTheFilledOne) {
  Film film({9000, 70});
  for (std::uint32_t tile = 0; tile < tile_count(film.size()); ++tile)
    for (int pass = 0; pass < pass_count; ++pass)
      if (tile >> pass & 1) put_pass(film, tile, pass);
  const Picture picture = preview(film, 4096);
  const std::vector<float> filled = film.filled();
  EXPECT_EQ(picture.size, (Size{3000, 24}));
  std::vector<float> expected;
  for (std::uint32_t y = 0; y < 70; y += 3)
    for (std::uint32_t x = 0; x < 9000; x += 3)
      for (int channel = 0; channel < 3; ++channel)
        expected.push_back(filled[3 * (y * 9000 + x) + static_cast<std::uint32_t>(channel)]);
  EXPECT_EQ(picture.rgb, expected);
}

}  // namespace
}  // namespace rayfarm
