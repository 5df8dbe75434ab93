// Rays that are counted: by a farm exactly as on one PC, and as many as the course's renderer traced.
#include <algorithm>
#include <random>

#include "tests/end_to_end/each_scene.h"

namespace rayfarm {
namespace {

using nlohmann::json;

class Counters : public EachScene {
 protected:
  json counted_here(const Words& picture) const {
    return json::parse(rayfarm(Words{"stats"} + picture + Words{"--json"}).out).at("counters");
  }
  /// By workers that die.
  json counted_by_farm(const Words& picture, unsigned seed) {
    std::mt19937 random(seed);
    const std::string id = submit(picture);
    kill_workers(id, random);
    wait_for_state(id, "done");
    given_back_ += job(id).at("tiles_given_back").get<std::uint64_t>();
    return job(id).at("counters");
  }
  Words adaptive_picture() const {
    Words words = picture();
    *std::next(std::ranges::find(words, "--spp")) = "16";
    return words + Words{"--sampler", "adapt1"};
  }
  void start_farm() {
    start_master({"--threads", "0"});
    start_workers_to_kill();
  }

  std::uint64_t given_back_ = 0;
};

TEST_P(Counters, OfAFarmAreThoseOfOnePCAlsoWhenWorkersDie) {
  start_farm();
  for (const Words& words : {picture(), picture() + Words{"--depth", "2"}, adaptive_picture()}) {
    const json expected = counted_here(words);
    EXPECT_GT(expected.at("misses"), 0);
    EXPECT_EQ(expected.at("lost"), 0);
    for (unsigned seed = 0; seed < 5; ++seed) EXPECT_EQ(counted_by_farm(words, seed), expected) << seed;
  }
  EXPECT_GT(given_back_, 5u) << "too few were killed in the middle of their work";
}

INSTANTIATE_TEST_SUITE_P(Five, Counters, testing::ValuesIn(five_scenes()), name_of_case);

class CountersOfOthers : public Counters {};

TEST_P(CountersOfOthers, OfAFarmAreThoseOfOnePC) {
  start_farm();
  const json expected = counted_here(picture());
  EXPECT_EQ(expected.at("lost"), 0);
  EXPECT_EQ(counted_by_farm(picture(), 0), expected);
}

INSTANTIATE_TEST_SUITE_P(Others, CountersOfOthers, testing::ValuesIn(other_scenes()), name_of_case);

class AdaptiveSamples : public FarmPrograms {};

TEST_F(AdaptiveSamples, AreAsManyAsTheCoursesRendererTook) {
  // Primary rays of the original program with sampling=adapt1, threshold 0.004, Supersampling 64.
  const std::pair<const char*, double> known[]{
      {"sphere_plane", 860'121}, {"hedgehog_in_the_cage", 465'051}, {"circus", 796'800}};
  for (const auto& [name, rays] : known) {
    const ProgramResult result = rayfarm(
        {"stats", scene_file(name), "--size", "320x180", "--spp", "64", "--sampler", "adapt1", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    // Both draw at random; over seeds ours vary by 0.1 %.
    EXPECT_NEAR(json::parse(result.out).at("counters").at("primary"), rays, 0.01 * rays) << name;
  }
}

}  // namespace
}  // namespace rayfarm
