// Where secrets are not: in logs, in the arguments of programs, in files that others may read, or kept at all when a hash
// will do.
#include <algorithm>

#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

/// The part that is drawn, as it is written and without its hyphens; the part before says only whose it is.
Words forms_of(const std::string& code) {
  const std::string drawn = code.substr(code.find('-', 20) + 1, 17);
  std::string letters = drawn;
  std::erase(letters, '-');
  return {drawn, letters};
}

/// The lines of a private key.
Words lines_of_key(const fs::path& file) {
  std::istringstream content(content_of(file));
  Words lines;
  bool is_key = false;
  for (std::string line; std::getline(content, line);) {
    if (line.starts_with("-----"))
      is_key = line.find("BEGIN") != line.npos && line.find("PRIVATE KEY") != line.npos;
    else if (is_key)
      lines.push_back(line);
  }
  return lines;
}

class Secrets : public FarmPrograms {
 protected:
  ProgramResult admin(const Words& words) const {
    return run_program(Words{"rayfarm"} + words,
                       {{"RAYFARM_MASTER", http()}, {"RAYFARM_TOKEN_FILE", farm / "admin.token"}});
  }
  std::string made(const Words& options) const {
    const ProgramResult result = admin(Words{"token", "new"} + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out.substr(0, result.out.find('\n'));
  }
  const fs::path farm = folder / "farm", pc = folder / "pc";
};

TEST_F(Secrets, StandInNoLogNoArgumentAndNoFileThatOthersRead) {
  start_master({"--threads", "0", "--state", farm, "--closed"});
  const std::string code = made({}), token = made({"--role", "artist"}),
                    link = made({"--role", "viewer", "--link"});
  Words secrets;
  for (const std::string& text :
       {code, token, link.substr(link.find("login/") + 6), content_of(farm / "admin.token")})
    std::ranges::copy(forms_of(text), std::back_inserter(secrets));

  put_content(folder / "code", code + "\n");
  const ProgramResult joined =
      run_program({"/bin/sh", "-c", "exec \"$0\" join - --name pc --state \"$1\" < \"$2\"",
                   fs::read_symlink("/proc/self/exe").parent_path() / "rayfarm-worker", pc, folder / "code"});
  ASSERT_EQ(joined.exit_code, 0) << joined.err;
  fs::remove(folder / "code");
  start_worker_with("pc", {"--state", pc, "--threads", "1"});
  put_content(folder / "ann.token", token + "\n");
  fs::permissions(folder / "ann.token", fs::perms::owner_read);
  const ProgramResult done =
      run_program({"rayfarm", "submit", scene_file("sphere_plane"), "--size", "64x64", "--spp", "1", "--wait",
                   "-o", folder / "a.exr"},
                  {{"RAYFARM_MASTER", http()}, {"RAYFARM_TOKEN_FILE", folder / "ann.token"}});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const ProgramResult misplaced = run_program(
      {"rayfarm", "jobs"}, {{"RAYFARM_MASTER", http()}, {"RAYFARM_TOKEN_FILE", farm / "authority.pem"}});
  EXPECT_EQ(misplaced.exit_code, 4) << misplaced.err;
  EXPECT_NE(content_of(folder / "ann.token").find(forms_of(token)[0]), std::string::npos)
      << "what is looked for is what would stand there";

  for (const fs::path& key : {farm / "authority.pem", farm / "master.pem", pc / "pairing.pem"}) {
    const Words lines = lines_of_key(key);
    EXPECT_FALSE(lines.empty()) << key;
    secrets = secrets + lines;
  }
  std::map<std::string, std::string> seen{{"the worker's answer", joined.out + joined.err},
                                          {"the command's answer", done.out + done.err},
                                          {"another answer", misplaced.out + misplaced.err}};
  for (const char* name : {"master", "pc"}) {
    EXPECT_NE(log_of(name), "");
    seen[name + std::string("'s log")] = log_of(name);
    const pid_t pid = (name == std::string("master") ? master() : worker(name)).pid();
    for (const char* file : {"cmdline", "environ"})
      seen[name + std::string("'s ") + file] = content_of("/proc/" + std::to_string(pid) + "/" + file);
  }
  for (const fs::path& state : {farm, pc})
    for (const auto& entry : fs::directory_iterator(state)) {
      const std::string name = entry.path().filename();
      EXPECT_EQ(entry.status().permissions(), fs::perms::owner_read | fs::perms::owner_write) << entry.path();
      if (name != "admin.token" && !name.ends_with(".pem")) seen[entry.path()] = content_of(entry.path());
    }
  EXPECT_TRUE(seen.contains(farm / "credentials.json") && seen.contains(farm / "journal.db"));
  for (const auto& [where, text] : seen)
    for (const std::string& secret : secrets)
      EXPECT_EQ(text.find(secret), std::string::npos) << "a secret stands in " << where;
}

}  // namespace
}  // namespace rayfarm
