#include "tests/end_to_end/farm_programs.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <regex>
#include <stdexcept>
#include <thread>

#include "master/http/client.h"

namespace rayfarm {

using nlohmann::json;

std::string scene_file(const std::string& name) { return RAYFARM_SOURCE_DIR "/scenes/" + name + ".lua"; }

Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

FarmPrograms::FarmPrograms() = default;
FarmPrograms::~FarmPrograms() = default;

void FarmPrograms::TearDown() {
  if (!HasFailure()) return;
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    if (file.path().extension() == ".log")
      ADD_FAILURE() << "--- " << file.path().filename().string() << "\n" << content_of(file.path());
}

void FarmPrograms::run_apart(const std::function<int()>& enter, const std::function<void()>& body) {
  constexpr int failed = 1, not_allowed = 100;  // exit codes: from 100 on, it is errno + 100
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const int error = enter();
    if (error == 0) try {
        body();
      } catch (const std::exception& fault) {
        ADD_FAILURE() << fault.what();
      }
    kill_all();
    TearDown();
    std::fflush(nullptr);
    ::_exit(error != 0 ? not_allowed + error : HasFailure() ? failed : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "what ran apart was killed";
  const int code = WEXITSTATUS(status);
  if (code >= not_allowed) GTEST_SKIP() << "no world of its own: " << std::strerror(code - not_allowed);
  EXPECT_EQ(code, 0) << "see above";
}

// The daemons. ---------------------------------------------------------------------------------------------

void FarmPrograms::start_master(const Words& options, const std::string& listen) {
  Words words{"rayfarm-master", "--listen", listen};
  if (std::ranges::find(options, "--http") == options.end()) words = words + Words{"--http", "127.0.0.1:0"};
  master_ = std::make_unique<ChildProgram>(words + options, std::map<std::string, std::string>{},
                                           folder / "master.log");
  const std::string line = master_->next_line();
  std::smatch found;
  if (!std::regex_match(line, found, std::regex("rayfarm-master: workers (\\S+), http (\\S+)")))
    throw std::runtime_error("the master did not start: " + line + log_of("master"));
  farm_address_ = found[1], http_ = found[2];
}

void FarmPrograms::start_worker(const std::string& name, int threads) {
  start_worker_with(name, {"--master", farm_address_, "--threads", std::to_string(threads)});
}

void FarmPrograms::start_worker_with(const std::string& name, const Words& options) {
  start_program(name, Words{"rayfarm-worker", "--name", name} + options);
}

void FarmPrograms::start_program(const std::string& name, const Words& words) {
  workers_[name] =
      std::make_unique<ChildProgram>(words, std::map<std::string, std::string>{}, folder / (name + ".log"));
}

std::string FarmPrograms::start_listening_worker(const std::string& name) {
  start_program(name, {"rayfarm-worker", "--listen", "127.0.0.1:0", "--name", name, "--threads", "1"});
  return workers_[name]->next_line();
}

void FarmPrograms::kill_all() {
  workers_.clear();
  master_.reset();
}

std::string FarmPrograms::log_of(const std::string& name) const {
  return content_of(folder / (name + ".log"));
}

// What people do. ------------------------------------------------------------------------------------------

ProgramResult FarmPrograms::rayfarm(const Words& words) const {
  return run_program(Words{"rayfarm"} + words, {{"RAYFARM_MASTER", http_}});
}

std::string FarmPrograms::submit(const Words& picture, const Words& options) {
  const ProgramResult result = rayfarm(Words{"submit"} + picture + Words{"-o", folder / "job.exr"} + options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out.substr(0, result.out.find('\n'));
}

std::string FarmPrograms::rendered_here(const Words& picture, int threads) {
  const std::string file = folder / "here.exr";
  const ProgramResult result =
      rayfarm(Words{"render"} + picture + Words{"-o", file, "--threads", std::to_string(threads)});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return content_of(file);
}

std::string FarmPrograms::rendered_by_farm(const Words& picture) {
  std::filesystem::remove(folder / "job.exr");
  submit(picture, {"--wait"});
  return content_of(folder / "job.exr");
}

std::string FarmPrograms::fetched(const std::string& job) {
  const std::string file = folder / "fetched.exr";
  std::filesystem::remove(file);
  const ProgramResult result = rayfarm({"fetch", job, "-o", file});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return content_of(file);
}

// What the farm says. --------------------------------------------------------------------------------------

json FarmPrograms::ask(const std::string& target) const {
  const HttpReply reply = send({.url = http_, .target = target, .body = {}});
  if (reply.status != 200) throw std::runtime_error(target + ": " + reply.body);
  return json::parse(reply.body);
}

json FarmPrograms::job(const std::string& id) const { return ask("/api/v1/jobs/" + id); }
std::string FarmPrograms::state_of(const std::string& id) const { return job(id).at("state"); }
std::uint64_t FarmPrograms::pixels_of(const std::string& id) const { return job(id).at("pixels_done"); }

json FarmPrograms::workers() const {
  const json all = ask("/api/v1/workers").at("workers");
  json here = json::array();
  for (const json& worker : all)
    if (worker.at("state") != "dialling" && worker.at("state") != "banned") here.push_back(worker);
  return here;
}

json FarmPrograms::worker_view(const std::string& name) const {
  for (const json& worker : workers())
    if (worker.at("name") == name) return worker;
  return nullptr;
}

bool FarmPrograms::is_here(const std::string& name) const { return !worker_view(name).is_null(); }

std::uint32_t FarmPrograms::leases_of(const std::string& name) const {
  const json worker = worker_view(name);
  return worker.is_null() ? 0 : worker.at("leases").get<std::uint32_t>();
}

FarmPrograms::Deadline::Deadline(std::string what)
    : what_(std::move(what)), end_(std::chrono::steady_clock::now() + test_patience) {}

void FarmPrograms::Deadline::pause() const {
  if (std::chrono::steady_clock::now() > end_) throw std::runtime_error("in vain waited for this: " + what_);
  std::this_thread::sleep_for(std::chrono::milliseconds(3));  // leaves the processors to those who work
}

void FarmPrograms::wait_for_workers(std::size_t count) const {
  wait_until(std::to_string(count) + " workers are here", [&] { return workers().size() == count; });
}

void FarmPrograms::wait_for_state(const std::string& id, const std::string& state) const {
  wait_until("job " + id + " is " + state, [&] { return state_of(id) == state; });
}

void FarmPrograms::wait_for_pixels(const std::string& id) const {
  wait_until("something of job " + id + " is rendered", [&] { return pixels_of(id) > 0; });
}

}  // namespace rayfarm
