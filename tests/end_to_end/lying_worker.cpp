// A worker that lies, of the real one's parts: lying_worker MASTER NAME ulp|percent|nan SEED. Of its tiles about one in
// three is wrong.
#include <asio/io_context.hpp>
#include <atomic>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <random>

#include "common/net/run_until_end.h"
#include "tests/support/lying_renderer.h"
#include "worker/worker.h"

namespace rayfarm {
namespace {

using Lie = void (*)(std::vector<PassImage>&);

void lie_by_one_percent(std::vector<PassImage>& images) {
  for (PassImage& image : images)
    for (std::size_t i = 0; i < image.rgb.size(); i += 300) image.rgb[i] += 0.5f;
}
void lie_by_no_number(std::vector<PassImage>& images) {
  images.front().rgb.front() = std::numeric_limits<float>::quiet_NaN();
}

const std::map<std::string, Lie> lies{
    {"ulp", lie_by_one_ulp}, {"percent", lie_by_one_percent}, {"nan", lie_by_no_number}};

void serve(const std::string& master, const std::string& name, Lie lie, unsigned seed) {
  asio::io_context io;
  std::random_device chance;
  WorkerOptions options;
  options.way = DialMaster{parse_address(master, default_farm_port)};
  options.identity = {name, "a liar's CPU", 1, std::uint64_t{chance()} << 32 | chance()};
  std::minstd_rand random(seed);  // of its one thread
  const auto sometimes = [&](std::vector<PassImage>& images) {
    if (random() % 3 == 0) lie(images);
  };
  WorkerDaemon worker(io, std::move(options), lying(prepare_scene, sometimes));
  run_until_end(io, worker.run());
}

}  // namespace
}  // namespace rayfarm

int main(int, char** words) {
  rayfarm::serve(words[1], words[2], rayfarm::lies.at(words[3]), static_cast<unsigned>(std::stoul(words[4])));
}
