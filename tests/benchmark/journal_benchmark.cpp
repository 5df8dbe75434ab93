// How soon a killed master serves again with 1,000 jobs and 100,000 tile records in its journal, and what of that the
// journal takes; and what writing a tile to the journal costs.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "common/net/codec.h"
#include "master/http/client.h"
#include "master/journal/journal.h"
#include "tests/master/farm/fake_worker.h"
#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int jobs = 1000, tiles = 100, repetitions = 40;
constexpr Size picture{tiles * tile_side, 4};  // that many tiles, and the farm keeps all of the films
constexpr std::size_t scene_bytes = 10'000;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void report(const char* what, std::vector<double> times) {
  std::ranges::sort(times);
  const std::size_t last = times.size() - 1;
  std::printf("%-60s median %7.2f ms, p99 %7.2f ms (%zu runs)\n", what, 1e3 * times[last / 2],
              1e3 * times[(last * 99 + 99) / 100], times.size());
}

void fill(const std::filesystem::path& file) {
  Journal journal(file);
  Farm farm;
  FakeWorker pc(farm, {.name = "pc"}, 0s);
  std::vector<double> times;
  for (int i = 0; i < jobs; ++i) {
    JobSpec spec = job_of(picture, "picture " + std::to_string(i), "scene " + std::to_string(i));
    spec.scene_bytes = std::make_shared<const Bytes>(scene_bytes, static_cast<std::uint8_t>(i));
    farm.submit(std::move(spec), FarmTime(i));
    pc.finish_all(FarmTime(i));
    const auto records = farm.take_records();
    const auto begin = Clock::now();
    while (!journal.write(records)) {}
    times.push_back(seconds_since(begin));
  }
  report("a job of 100 tiles of 64x4 is written, in one transaction", std::move(times));
  std::fflush(stdout);
  std::_Exit(0);  // as when it is killed
}

void read_in_process(const std::filesystem::path& file) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const auto begin = Clock::now();
    Journal journal(file);
    Journal::Opened opened = journal.read();
    const FarmTime latest = opened.latest;
    const Farm farm({}, std::move(opened.past), latest);
    times.push_back(seconds_since(begin));
    if (farm.jobs(latest).size() != jobs) std::abort();
  }
  report("the journal is opened, and the farm built again", std::move(times));
}

/// From the start of the process to its first answer; then it is killed.
double time_to_serve(const std::vector<std::string>& options, const std::string& target) {
  std::vector<std::string> words{"rayfarm-master", "--listen", "127.0.0.1:0", "--http", "127.0.0.1:0",
                                 "--threads",      "0"};
  words.insert(words.end(), options.begin(), options.end());
  const auto begin = Clock::now();
  ChildProgram master(words, {}, "/dev/null");
  const std::string line = master.next_line();
  const HttpReply reply = send({.url = line.substr(line.rfind(' ') + 1), .target = target, .body = {}});
  const double time = seconds_since(begin);
  if (reply.status != 200) throw std::runtime_error(reply.body);
  return time;
}

void serve_again(const char* what, const std::vector<std::string>& options, const std::string& target) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) times.push_back(time_to_serve(options, target));
  report(what, std::move(times));
}

}  // namespace
}  // namespace rayfarm

int main() {
  using namespace rayfarm;
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "journal.db";
  if (const pid_t filler = ::fork(); filler == 0)
    fill(file);
  else
    ::waitpid(filler, nullptr, 0);
  read_in_process(file);
  serve_again("a master without a state serves", {}, "/api/v1/jobs");
  serve_again("a killed master serves again, a job of 1,000", {"--state", folder.path()},
              "/api/v1/jobs/1000");
}
