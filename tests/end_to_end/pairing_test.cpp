// How PCs become workers, and stop to be: the real programs, everything encrypted also on loopback.
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

class Pairing : public FarmPrograms {
 protected:
  /// CODE@HOST:PORT.
  std::string new_code(const Words& options = {}) {
    const ProgramResult made = rayfarm(Words{"token", "new"} + options);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return made.out.substr(0, made.out.find('\n'));
  }
  std::string state_of_pc(const std::string& name) const { return (folder / (name + "-state")).string(); }
  ProgramResult join(const std::string& code, const std::string& name) const {
    return run_program({"rayfarm-worker", "join", code, "--name", name, "--state", state_of_pc(name)});
  }
  void start_joined(const std::string& name) {
    start_worker_with(name, {"--state", state_of_pc(name), "--threads", "1"});
  }
  void wait_for_log(const std::string& name, const std::string& words) const {
    wait_until(name + " says: " + words, [&] { return log_of(name).find(words) != std::string::npos; });
  }
  void start_farm() { start_master({"--threads", "0", "--state", folder / "farm"}); }

  const Words picture{scene_file("sphere_flake"), "--size", "200x150", "--spp", "1"};
};

TEST_F(Pairing, MakesPcsWorkersThatEncryptAndRenderTheSameBytes) {
  start_farm();
  const std::string code = new_code({"--uses", "2"});
  for (const char* name : {"lab1", "lab2"}) {
    const ProgramResult joined = join(code, name);
    EXPECT_EQ(joined.exit_code, 0) << joined.err;
    start_joined(name);
  }
  wait_for_workers(2);
  wait_for_log("lab1", "encrypted");
  EXPECT_TRUE(rendered_by_farm(picture) == rendered_here(picture));

  const ProgramResult third = join(code, "lab3");
  EXPECT_EQ(third.exit_code, 4) << third.err;
  wait_for_log("master", "was used already");
  EXPECT_EQ(third.err.find("was used already"), std::string::npos) << "a stranger is not told why";
}

TEST_F(Pairing, OutlivesTheMasterAndTheWorker) {
  start_farm();
  EXPECT_EQ(join(new_code(), "lab1").exit_code, 0);
  const std::string address = farm_address();
  start_joined("lab1");
  wait_for_workers(1);
  kill_all();
  start_master({"--threads", "0", "--state", folder / "farm"}, address);
  start_joined("lab1");
  wait_for_workers(1);
}

TEST_F(Pairing, EndsAtOnceWhenItIsRevoked) {
  start_farm();
  EXPECT_EQ(join(new_code(), "lab1").exit_code, 0);
  start_joined("lab1");
  wait_for_workers(1);
  const ProgramResult revoked = rayfarm({"token", "revoke", "lab1"});
  EXPECT_EQ(revoked.exit_code, 0) << revoked.err;
  wait_for_workers(0);
  wait_for_log("master", "the certificate of \"lab1\" is refused");
  EXPECT_NE(log_of("master").find("worker lab1 lost: its certificate was revoked"), std::string::npos);
  EXPECT_EQ(log_of("lab1").find("revoked"), std::string::npos) << "it is not told why";
  EXPECT_EQ(workers().size(), 0u);
  EXPECT_NE(rayfarm({"token", "list"}).out.find("revoked"), std::string::npos);
}

TEST_F(Pairing, WithAnotherFarmsCodeTellsTheMasterNothing) {
  start_farm();
  const std::string code = new_code();
  start_master({"--threads", "0", "--state", folder / "other"});
  const std::string elsewhere = code.substr(0, code.find('@')) + "@" + farm_address();
  const ProgramResult joined = join(elsewhere, "lab1");
  EXPECT_EQ(joined.exit_code, 4) << joined.err;
  EXPECT_NE(joined.err.find("nothing was told to it"), std::string::npos) << joined.err;
  EXPECT_FALSE(std::filesystem::exists(state_of_pc("lab1") + "/pairing.pem"));
}

TEST_F(Pairing, TakesACodeFromStandardInputAndNoneWithALetterTooMany) {
  start_farm();
  const std::string code = new_code();
  const std::string wrong = "7" + code;
  const ProgramResult misread = join(wrong, "lab1");
  EXPECT_EQ(misread.exit_code, 2) << misread.err;
  EXPECT_EQ(misread.err.find(wrong.substr(0, 5)), std::string::npos) << "no secret in messages";
  put_content(folder / "code", code + "\n");
  const ProgramResult piped =
      run_program({"/bin/sh", "-c", "exec \"$0\" join - --name lab1 --state \"$1\" < \"$2\"",
                   std::filesystem::read_symlink("/proc/self/exe").parent_path() / "rayfarm-worker",
                   state_of_pc("lab1"), folder / "code"});
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
}

TEST_F(Pairing, UsesNoCodeUpThatCannotHelp) {
  start_farm();
  const std::string code = new_code();
  for (const std::string& name : {std::string(), std::string("a\nb"), std::string(65, 'x')})
    EXPECT_EQ(join(code, name).exit_code, 2) << name;
  put_content(folder / "file", "");
  const ProgramResult nowhere =
      run_program({"rayfarm-worker", "join", code, "--name", "lab1", "--state", folder / "file/state"});
  EXPECT_NE(nowhere.exit_code, 0);
  EXPECT_NE(nowhere.err.find("choose another folder with --state"), std::string::npos) << nowhere.err;
  EXPECT_EQ(join(code, "lab1").exit_code, 0);
}

TEST_F(Pairing, IsWhatAClosedMasterAsksOfEverybody) {
  start_master({"--threads", "0", "--state", folder / "farm", "--closed"});
  start_worker("stranger");
  wait_for_log("master", "it does not encrypt what it says");
  const auto command = [&](const std::map<std::string, std::string>& environment) {
    std::map<std::string, std::string> all = environment;
    all["RAYFARM_MASTER"] = http();
    return run_program({"rayfarm", "workers"}, all);
  };
  EXPECT_TRUE(http().starts_with("https://")) << http();
  EXPECT_EQ(command({}).exit_code, 4);
  const ProgramResult admin = command({{"RAYFARM_TOKEN_FILE", folder / "farm/admin.token"}});
  EXPECT_EQ(admin.exit_code, 0) << admin.err;

  const ProgramResult worker = run_program(
      {"rayfarm-worker", "--closed", "--master", farm_address(), "--state", state_of_pc("stranger")});
  EXPECT_EQ(worker.exit_code, 2);
  EXPECT_NE(worker.err.find("rayfarm-worker join"), std::string::npos) << worker.err;
}

}  // namespace
}  // namespace rayfarm
