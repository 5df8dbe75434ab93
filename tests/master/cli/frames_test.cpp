// Frames of an animation, rendered here and by a farm: the same files.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <utility>

#include "master/files/image_file.h"
#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_server.h"
#include "tests/support/turning_scene.h"

namespace rayfarm {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

class Frames : public testing::Test {
 protected:
  Frames() {
    put_content(folder / "turning.lua", turning_scene);
    put_content(folder / "still.lua", "return scene{ root = sphere{}:translate(0, 0, 5) }");
  }
  ProgramResult rayfarm(Words words, const std::map<std::string, std::string>& environment = {}) const {
    words.insert(words.begin(), "rayfarm");
    return run_program(std::move(words), environment);
  }
  ProgramResult render(const std::string& frames, const std::string& output, const Words& more = {}) const {
    Words words{"render", folder / "turning.lua", "--frames", frames, "-o", folder / output};
    words.insert(words.end(), more.begin(), more.end());
    return rayfarm(words);
  }
  std::string content(const std::string& file) const { return content_of(folder / file); }

  ScratchFolder folder;
};

TEST_F(Frames, AreTheFilesThatTheSingleFramesAre) {
  const ProgramResult all = render("2-6:2", "all.###.exr");
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_NE(all.out.find("3 frames of 160x90"), std::string::npos) << all.out;
  for (const char* frame : {"2", "4", "6"}) {
    const Words one{"render", folder / "turning.lua", "--frame", frame, "-o", folder / "one.###.exr"};
    ASSERT_EQ(rayfarm(one).exit_code, 0);
    EXPECT_EQ(content(std::string("all.00") + frame + ".exr"),
              content(std::string("one.00") + frame + ".exr"));
  }
  EXPECT_NE(content("all.002.exr"), content("all.004.exr"));
  EXPECT_EQ(folder.file_count(), 2u + 6u);
  EXPECT_EQ(read_picture(folder / "all.004.exr").facts.at("rayfarm:frame"), "4");
}

TEST_F(Frames, AreSummarisedAsJson) {
  const json summary = json::parse(render("0-1", "a.##.png", {"--json"}).out);
  ASSERT_EQ(summary["frames"].size(), 2u);
  EXPECT_EQ(summary["frames"][1]["settings"]["frame"], 1);
  EXPECT_EQ(summary["frames"][1]["output"], (folder / "a.01.png").string());
  EXPECT_EQ(summary["counters"]["primary"], 2 * 160 * 90 * 4);
}

/// Delivers black pixels until it breaks the rules.
struct Liar {
  explicit Liar(FarmThread& farm) {
    farm.run([&](Farm& f, FarmTime now) {
      const auto hold = [this](ToWorker message) {
        if (const auto* work = std::get_if<Assignment>(&message)) held.push_back(*work);
      };
      id = f.add_worker({.name = "liar", .threads = 8}, hold, now);
    });
  }
  void deliver(Farm& farm, FarmTime now, float colour, std::uint32_t last_frame) {
    const std::vector<Assignment> all = std::exchange(held, {});
    for (const Assignment& work : all) {
      if (work.frame > last_frame) held.push_back(work);
      if (work.frame > last_frame) continue;
      Result result{work.lease, work.job, work.frame, work.tile, {}, 0.001};
      for (int pass = 0; pass < pass_count; ++pass) {
        const std::uint32_t pixels = pixel_count(tile_at({160, 90}, work.tile), pass);
        result.images.push_back({pass, std::vector<float>(3 * pixels, colour), {}});
      }
      farm.receive(id, result, now);
    }
  }
  WorkerId id{};
  std::vector<Assignment> held;  // on the farm's thread
};

// A frame that was written once had stayed as a liar had made it.
TEST_F(Frames, ThatALiarMadeAreWrittenAgainOnceItIsSeen) {
  ASSERT_EQ(render("0-2", "here.#.exr").exit_code, 0);
  FarmThread farm;
  TestServer server(door_to(farm));
  Liar liar(farm);
  const Words words{"submit", folder / "turning.lua", "--frames", "0-2",
                    "-o",     folder / "farm.#.exr",  "--wait"};
  auto submitted = std::async(std::launch::async, [&] {
    return rayfarm(words, {{"RAYFARM_MASTER", server.url()}});
  });
  while (!std::filesystem::exists(folder / "farm.1.exr"))
    farm.run([&](Farm& f, FarmTime now) { liar.deliver(f, now, 0, 1); });
  bool was_caught = false;
  while (!was_caught)
    farm.run([&](Farm& f, FarmTime now) {
      try {
        liar.deliver(f, now, NAN, 2);
      } catch (const WorkerError&) {
        f.remove_worker(liar.id, "it lied", now);
        was_caught = true;
      }
    });
  farm.add_renderer("honest");
  const ProgramResult result = submitted.get();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* frame : {"0", "1", "2"})
    EXPECT_EQ(content(std::string("farm.") + frame + ".exr"), content(std::string("here.") + frame + ".exr"));
}

TEST_F(Frames, ThatCannotBeAreRefusedWithWhatThereIs) {
  const auto refused = [&](const Words& words, const std::string& message) {
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(folder.file_count(), 2u);
  };
  const std::string turning = folder / "turning.lua", still = folder / "still.lua",
                    files = folder / "a.####.png";
  for (const char* command : {"render", "submit"}) {
    refused({command, turning, "--frames", "0-21", "-o", files},
            "last frame is 20 (from 1 s to 3 s, 10 frames");
    refused({command, turning, "--frames", "30-40", "-o", files}, "last frame is 20");
    refused({command, turning, "--frame", "21", "-o", files}, "last frame is 20");
    refused({command, still, "--frames", "0-3", "-o", files}, "still.lua: the scene has no animation");
    refused({command, still, "--frame", "1", "-o", files}, "no frame 1: the scene has no animation");
    refused({command, turning, "--frames", "0-4", "-o", files, "--video", folder / "turn.foo"},
            std::string_view(command) == "render" ? "kind of video" : "--wait");
    refused({command, turning, "--frames", "3-1", "-o", files}, "3-1");
    refused({command, turning, "--frames", "a-b", "-o", files}, "--frames wants A-B");
    refused({command, turning, "--frames", "0-4:0", "-o", files}, "step");
    refused({command, turning, "--frames", "0-4", "-o", folder / "a.png"}, "a.####.png");
    refused({command, turning, "--frames", "0-4", "--frame", "2", "-o", files}, "--frame");
  }
}

TEST_F(Frames, AScriptThatFailsInOneOfThemKeepsTheOthersAndSaysWhich) {
  put_content(folder / "bad.lua",
              "return scene{ root = sphere{}:scale(2 - time), animation = { stop = 3, fps = 1 } }");
  const ProgramResult result =
      rayfarm({"render", folder / "bad.lua", "--frames", "0-3", "-o", folder / "a.#.png", "--size", "8x8"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("frame 2: bad.lua:1"), std::string::npos) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "a.1.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.2.png"));
}

TEST_F(Frames, InterruptedItKeepsThoseThatAreDone) {
  ChildProgram program({"rayfarm", "render", folder / "turning.lua", "--frames", "0-20", "-o",
                        folder / "a.##.png", "--size", "640x480", "--spp", "64"});
  while (!std::filesystem::exists(folder / "a.00.png")) std::this_thread::yield();
  program.send_signal(SIGINT);
  const ProgramResult result = program.result();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_NE(result.err.find("are written"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.20.png"));
}

TEST_F(Frames, BecomeAVideoByFfmpeg) {
  put_content(folder / "ffmpeg",
              "#!/bin/sh\nfor last; do :; done\necho \"$@\" > \"$0.arguments\"\nexec cat > \"$last\"\n");
  std::filesystem::permissions(folder / "ffmpeg", std::filesystem::perms::owner_all);
  const std::map<std::string, std::string> path{{"PATH", folder.path().string() + ":/usr/bin:/bin"}};
  const Words words{"render", folder / "turning.lua", "--frames", "0-4:2",
                    "-o",     folder / "a.#.png",     "--video",  folder / "turn.mp4"};
  const ProgramResult result = rayfarm(words, path);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(content("turn.mp4"), content("a.0.png") + content("a.2.png") + content("a.4.png"));
  EXPECT_NE(content("ffmpeg.arguments").find("-framerate 5.0"), std::string::npos);

  put_content(folder / "ffmpeg", "#!/bin/sh\nexit 1\n");
  const ProgramResult failed = rayfarm(words, path);
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_NE(content("turn.mp4").size(), 0u) << "the old one stays";
  const ProgramResult none = rayfarm(words, {{"PATH", "/nowhere"}});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("needs ffmpeg"), std::string::npos) << none.err;
}

/// What the real one makes of it, seen by its companion.
TEST_F(Frames, AreAsManyInTheVideoThatFfmpegMakes) {
  for (const auto& [file, rate] : {std::pair{"turn.mp4", "5/1"},
                                   {"turn.webm", "5/1"},
                                   {"turn.MKV", "5/1"},
                                   {"turn.mov", "5/1"},
                                   {"turn.avi", "5/1"},
                                   {"turn.gif", "5/1"}}) {
    const ProgramResult made = render("0-8:2", "a.#.png", {"--video", folder / file, "--size", "161x91"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const ProgramResult seen =
        run_program({"/usr/bin/ffprobe", "-v", "error", "-count_frames", "-show_entries",
                     "stream=nb_read_frames,r_frame_rate,width,height", "-of", "default=noprint_wrappers=1",
                     folder / file});
    ASSERT_EQ(seen.exit_code, 0) << seen.err << " (apt install ffmpeg)";
    EXPECT_EQ(seen.out, std::string("width=162\nheight=92\nr_frame_rate=") + rate + "\nnb_read_frames=5\n");
  }
}

// By a farm. -----------------------------------------------------------------------------------------------

class FarmFrames : public Frames {
 protected:
  ProgramResult ask(Words words) const {
    return rayfarm(std::move(words), {{"RAYFARM_MASTER", server.url()}});
  }
  std::string submit(const std::string& frames, const Words& more = {}) const {
    Words words{"submit", folder / "turning.lua", "--frames", frames, "-o", folder / "farm.##.exr"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = ask(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out.substr(0, result.out.find('\n'));
  }
  void expect_local_files(const std::string& frames, const std::vector<std::string>& numbers) const {
    ASSERT_EQ(render(frames, "local.##.exr").exit_code, 0);
    for (const std::string& number : numbers)
      EXPECT_EQ(content("farm." + number + ".exr"), content("local." + number + ".exr")) << number;
  }

  FarmThread farm;
  TestServer server{door_to(farm)};
};

TEST_F(FarmFrames, AreTheLocalFiles) {
  farm.add_renderer("pc1");
  const std::string id = submit("3-9:3", {"--wait"});
  expect_local_files("3-9:3", {"03", "06", "09"});
  json job = json::parse(ask({"job", id, "--json"}).out);
  EXPECT_GT(job["frames"]["version"], 0);
  job["frames"].erase("version");
  EXPECT_EQ(job["frames"], json({{"first", 3},
                                 {"last", 9},
                                 {"step", 3},
                                 {"total", 3},
                                 {"sent", 3},
                                 {"done", 3},
                                 {"current", nullptr}}));
  EXPECT_EQ(job["counters"]["primary"], 3 * 160 * 90 * 4);
  EXPECT_NE(ask({"jobs"}).out.find("3/3"), std::string::npos);
}

TEST_F(FarmFrames, AreFetchedAllOrOne) {
  farm.add_renderer("pc1");
  const std::string id = submit("0-1");
  EXPECT_EQ(ask({"watch", id}).exit_code, 0);
  const ProgramResult fetched = ask({"fetch", id});
  ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
  EXPECT_EQ(fetched.out, (folder / "farm.00.exr").string() + "\n" + (folder / "farm.01.exr").string() + "\n");
  expect_local_files("0-1", {"00", "01"});
  EXPECT_EQ(ask({"fetch", id, "--frame", "1", "-o", folder / "one.exr"}).exit_code, 0);
  EXPECT_EQ(content("one.exr"), content("local.01.exr"));
  EXPECT_EQ(ask({"fetch", id, "--frame", "2", "-o", folder / "one.exr"}).exit_code, 2);
  EXPECT_EQ(ask({"fetch", id, "-o", folder / "one.exr"}).exit_code, 2) << "where do the numbers go?";
}

TEST_F(FarmFrames, ThoseThatAreDoneCanBeFetchedBeforeTheOthers) {
  farm.add_renderer("pc1", 7);  // of the six tiles that each frame has
  const std::string id = submit("0-2");
  while (json::parse(ask({"job", id, "--json"}).out)["pixels_done"] < 160 * 90 + 1) std::this_thread::yield();
  const ProgramResult fetched = ask({"fetch", id});
  EXPECT_EQ(fetched.exit_code, 7);
  EXPECT_NE(fetched.err.find("1 of 3 frames"), std::string::npos) << fetched.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "farm.00.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder / "farm.01.exr"));
  EXPECT_EQ(ask({"fetch", id, "--partial"}).exit_code, 7);
  EXPECT_TRUE(std::filesystem::exists(folder / "farm.01.exr"));
  EXPECT_EQ(ask({"fetch", id, "--frame", "1"}).exit_code, 1);
  EXPECT_EQ(ask({"fetch", id, "--frame", "1", "--partial"}).exit_code, 7);
}

TEST_F(FarmFrames, AreLookedIntoOneByOne) {
  farm.add_renderer("pc1");
  const std::string id = submit("0-2:2", {"--wait"});
  const auto of_job = [&](const Words& what, const std::string& frame) {
    Words words = what;
    words.insert(words.end(), {"--job", id, "--frame", frame});
    return ask(words);
  };
  const auto of_scene = [&](const Words& what, const std::string& frame) {
    Words words = what;
    words.insert(words.end(), {folder / "turning.lua", "--frame", frame});
    return ask(words);
  };
  EXPECT_EQ(of_job({"trace", "--pixel", "80,45", "--json"}, "2").out,
            of_scene({"trace", "--pixel", "80,45", "--json"}, "2").out);
  EXPECT_EQ(of_job({"map", "depth", "-o", folder / "job.csv"}, "2").exit_code, 0);
  EXPECT_EQ(of_scene({"map", "depth", "-o", folder / "scene.csv"}, "2").exit_code, 0);
  EXPECT_EQ(content("job.csv"), content("scene.csv"));
  json sum = json::parse(of_job({"stats", "--json"}, "0").out)["counters"];
  const json last = json::parse(of_job({"stats", "--json"}, "2").out)["counters"];
  for (auto& [name, count] : sum.items())
    count = count.get<std::uint64_t>() + last[name].get<std::uint64_t>();
  EXPECT_EQ(json::parse(ask({"stats", "--job", id, "--json"}).out)["counters"], sum);
  EXPECT_EQ(of_job({"map", "depth", "-o", folder / "job.csv"}, "1").exit_code, 1) << "it has no frame 1";
}

TEST_F(FarmFrames, OfAScriptThatFailsInTheMiddleAreCancelled) {
  put_content(folder / "turning.lua",
              "return scene{ root = sphere{}:scale(2 - time), animation = { stop = 3, fps = 1 } }");
  const ProgramResult result =
      ask({"submit", folder / "turning.lua", "--frames", "0-3", "-o", folder / "farm.##.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("frame 2: turning.lua:1"), std::string::npos) << result.err;
  EXPECT_EQ(json::parse(ask({"job", "1", "--json"}).out)["state"], "cancelled");
}

}  // namespace
}  // namespace rayfarm
