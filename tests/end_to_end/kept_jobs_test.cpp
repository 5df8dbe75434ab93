// What a master keeps of jobs that have ended is as its options say, also after a restart.
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

class KeptJobs : public FarmPrograms {
 protected:
  void start(const Words& options) {
    start_master(Words{"--threads", "1", "--state", folder / "state"} + options);
  }
  std::string done_job() {
    const std::string id = submit(picture);
    wait_for_state(id, "done");
    return id;
  }
  Words listed() const {
    Words ids;
    const auto answer = ask("/api/v1/jobs");
    for (const auto& job : answer.at("jobs")) ids.push_back(job.at("id").dump());
    return ids;
  }
  void expect_no_longer_kept(const std::string& id) {
    const ProgramResult fetch = rayfarm({"fetch", id, "-o", folder / "gone.exr"});
    EXPECT_EQ(fetch.exit_code, 1);
    EXPECT_NE(fetch.err.find("job " + id + " is no longer kept"), std::string::npos) << fetch.err;
  }

  const Words picture{scene_file("sphere_plane"), "--size", "40x30", "--spp", "1"};
};

TEST_F(KeptJobs, AreThoseThatEndedLastAndWereNotRemoved) {
  const std::string expected = rendered_here(picture);
  start({"--keep-jobs", "3"});
  for (const char* id : {"1", "2", "3", "4"}) EXPECT_EQ(done_job(), id);
  EXPECT_EQ(listed(), (Words{"2", "3", "4"}));
  expect_no_longer_kept("1");
  EXPECT_EQ(rayfarm({"remove", "3"}).exit_code, 0);
  EXPECT_EQ(listed(), (Words{"2", "4"}));

  kill_master();
  put_content(folder / "master.toml", "keep-jobs = 1\nkeep-days = 30\nkeep-gb = 1\n");
  start({"--config", folder / "master.toml"});
  EXPECT_EQ(listed(), Words{"4"});
  for (const char* id : {"1", "2", "3"}) expect_no_longer_kept(id);
  EXPECT_TRUE(fetched("4") == expected);
  EXPECT_EQ(done_job(), "5") << "no number is used twice";
}

TEST_F(KeptJobs, CannotBeNone) {
  for (const char* option : {"--keep-jobs", "--keep-days", "--keep-gb"}) {
    const ProgramResult run =
        run_program({"rayfarm-master", "--http", "127.0.0.1:0", "--listen", "127.0.0.1:0", option, "0"});
    EXPECT_EQ(run.exit_code, 2) << option;
    EXPECT_NE(run.err.find(option), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace rayfarm
