// A farm of our real programs on loopback: a master and its workers as child processes, the command before them.
// When a test fails, their logs are in its message.
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {

using Words = std::vector<std::string>;

/// The path of a bundled script.
std::string scene_file(const std::string& name);
Words operator+(Words first, const Words& second);

class FarmPrograms : public testing::Test {
 protected:
  FarmPrograms();
  ~FarmPrograms() override;
  void TearDown() override;

  // The daemons. What still runs is killed with the test.
  void start_master(const Words& options, const std::string& listen = "127.0.0.1:0");
  /// It dials the master.
  void start_worker(const std::string& name, int threads = 1);
  void start_worker_with(const std::string& name, const Words& options);
  /// Another program in a worker's place.
  void start_program(const std::string& name, const Words& words);
  /// The first line that it says on stdout.
  std::string start_listening_worker(const std::string& name);
  ChildProgram& master() { return *master_; }
  ChildProgram& worker(const std::string& name) { return *workers_.at(name); }
  /// As kill -9.
  void kill_worker(const std::string& name) { workers_.erase(name); }
  void kill_master() { master_.reset(); }
  void kill_all();
  /// ADDRESS:PORT where workers come.
  const std::string& farm_address() const { return farm_address_; }
  /// What a daemon has logged: "master", or a worker's name.
  std::string log_of(const std::string& name) const;

  // What people do.
  ProgramResult rayfarm(const Words& words) const;
  /// The job's id. `picture`: the script and the options of its picture.
  std::string submit(const Words& picture, const Words& options = {});
  /// The bytes of an EXR file: rendered without a farm; rendered by the farm; of a job that is done.
  std::string rendered_here(const Words& picture, int threads = 1);
  std::string rendered_by_farm(const Words& picture);
  std::string fetched(const std::string& job);

  // What the farm says.
  const std::string& http() const { return http_; }
  nlohmann::json ask(const std::string& target) const;
  nlohmann::json job(const std::string& id) const;
  std::string state_of(const std::string& id) const;
  std::uint64_t pixels_of(const std::string& id) const;
  nlohmann::json workers() const;  // that are here
  /// Null when it is not there.
  nlohmann::json worker_view(const std::string& name) const;
  bool is_here(const std::string& name) const;
  std::uint32_t leases_of(const std::string& name) const;

  /// Asks until the answer is yes. Throws after test_patience, saying what was waited for.
  template <class Condition>
  void wait_until(const std::string& what, Condition condition) const {
    for (const Deadline deadline(what); !condition(); deadline.pause()) {}
  }
  void wait_for_workers(std::size_t count) const;
  void wait_for_state(const std::string& job, const std::string& state) const;
  /// Something of the job is rendered.
  void wait_for_pixels(const std::string& job) const;

  /// Runs the test proper in a child process once enter() has put that into a world of its own; skips it when the machine
  /// allows none, as errno says that is returned. Its failures are told, logs with them.
  void run_apart(const std::function<int()>& enter, const std::function<void()>& body);

  ScratchFolder folder;

 private:
  class Deadline {
   public:
    explicit Deadline(std::string what);
    /// A glance's length; throws when the time is over.
    void pause() const;

   private:
    std::string what_;
    std::chrono::steady_clock::time_point end_;
  };

  std::unique_ptr<ChildProgram> master_;
  std::map<std::string, std::unique_ptr<ChildProgram>> workers_;
  std::string farm_address_, http_;
};

}  // namespace rayfarm
