// Nothing that a script does can harm its caller or keep it waiting: through the child process, as in
// earnest.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "master/script/exchange.h"
#include "master/script/script.h"
#include "master/script/spawn.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

/// Small limits, so that the tests are quick; wall clock is the last resort.
const ScriptLimits limits{20s, 1, 64 << 20};
const std::string good = "return scene{ root = sphere{} }";

std::string complaint(const std::string& text, const ScriptLimits& held_to = limits) {
  try {
    evaluate({"bad.lua", text, {}, 0}, held_to);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

void expect_endless(const std::string& text, const std::string& line) {
  EXPECT_EQ(
      complaint(text),
      "bad.lua:" + line + ": the script takes more than 1 s of processor time, is this an endless loop?");
}

TEST(Sandbox, AGoodScriptComesThroughAsItIsInProcess) {
  const ScriptResult result =
      evaluate({"good.lua",
                "local n = param{ 'n', default = 2, min = 0.5, choices = nil }\n" + good,
                {{"n", "3"}},
                0});
  EXPECT_EQ(result.scene.nodes.size(), 1u);
  ASSERT_EQ(result.parameters.size(), 1u);
  EXPECT_EQ(result.parameters[0], (ScriptParameter{"n", "int", "2", "", {}, 0.5, {}}));
}

TEST(Sandbox, AnErrorComesThroughAsItIs) {
  EXPECT_EQ(complaint("local a = 1\ntorus{ 1, -1 }"), "bad.lua:2: torus: r must be positive, is -1");
  EXPECT_EQ(complaint("x = = 1"), "bad.lua:1: unexpected symbol near '='");
  EXPECT_EQ(complaint("error('\xff\xfe')"), "bad.lua:1: \uFFFD\uFFFD");
}

TEST(Sandbox, AnEvaluationIsStoppedWhenNobodyWantsItAnyMore) {
  int asked = 0;
  try {
    evaluate({"endless.lua", "while true do end", {}, 0, {}}, {20s, 15, 64 << 20},
             [&] { return ++asked == 3; });
    ADD_FAILURE();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(), "endless.lua: interrupted");
  }
  EXPECT_EQ(asked, 3);
}

TEST(Sandbox, EndlessLoopsEndWithTheirLine) {
  expect_endless("\nwhile true do end", "2");
  expect_endless("\n::again:: goto again", "2");
  expect_endless("local function f()\nreturn f() end f()", "2");
}

TEST(Sandbox, EndlessLoopsCannotHideInPcallOrCoroutines) {
  EXPECT_NE(complaint("while true do pcall(function() while true do end end) end").find("endless loop"),
            std::string::npos);
  EXPECT_NE(complaint("while true do local c = coroutine.wrap(function() while true do end end) pcall(c) end")
                .find("endless loop"),
            std::string::npos);
  EXPECT_NE(complaint("pcall(table.sort, {1, 2, 3}, function() while true do end end)\nwhile true do end")
                .find("endless loop"),
            std::string::npos);
  EXPECT_NE(
      complaint(
          "local t <close> = setmetatable({}, { __close = function() while true do end end }) error('x')")
          .find("endless loop"),
      std::string::npos);
}

TEST(Sandbox, HandlersAndFinalizersThatNoLimitReachesAreNotThere) {
  EXPECT_EQ(complaint("xpcall(error, function() while true do end end)"),
            "bad.lua:1: 'xpcall' is not available in a scene script");
  EXPECT_EQ(complaint("setmetatable({}, { __gc = function() while true do end end })"),
            "bad.lua:1: setmetatable: __gc is not available in a scene script");
  // Set afterwards, Lua does not heed it.
  EXPECT_EQ(complaint("for i = 1, 1000 do local m = {} setmetatable({}, m) m.__gc = function() while true do "
                      "end end end " +
                      good),
            "");
}

TEST(Sandbox, ALibraryCallThatNeverReturnsIsEndedFromOutside) {
  const std::string bomb = "string.find(('a'):rep(40), ('a?'):rep(40) .. ('a'):rep(40))";
  EXPECT_EQ(complaint(bomb),
            "bad.lua: the script takes more than 1 s of processor time: an endless loop, or a string "
            "pattern with many repetitions?");
  EXPECT_EQ(complaint("table.concat(setmetatable({}, { __len = function() return 1 << 60 end, __index = "
                      "function() return '' end }))")
                .empty(),
            false);
}

TEST(Sandbox, TheWallClockEndsWhatWaits) {
  EXPECT_EQ(complaint("while true do end", {300ms, 10, 64 << 20}),
            "bad.lua: the script takes more than 0.30 s, is there an endless loop?");
}

TEST(Sandbox, MemoryBombsEndWithAClearError) {
  EXPECT_EQ(complaint("local s = ('x'):rep(1 << 40)").substr(0, 8), "bad.lua:");
  for (const char* bomb :
       {"local s = ('x'):rep(1 << 30)", "local t = {} for i = 1, math.huge do t[i] = { i } end",
        "local s = 'x' while true do s = s .. s end",
        "local t = {} while true do t[#t + 1] = sphere{}:scale(2) end"})
    EXPECT_EQ(complaint(bomb, {60s, 60, 64 << 20}),
              "bad.lua: not enough memory: the script's values take more than 64 MB");
}

TEST(Sandbox, DeepNestingEndsWithAClearError) {
  EXPECT_NE(complaint("local function f() return 1 + f() end f()", {20s, 1, 1 << 30}).find("stack overflow"),
            std::string::npos);
  EXPECT_NE(complaint("return " + std::string(100'000, '(')).find("nested too deep"), std::string::npos);
  EXPECT_NE(
      complaint(
          "local t = setmetatable({}, {}) getmetatable(t).__index = function(_, k) return t[k] end t.x = t.y")
          .find("overflow"),
      std::string::npos);
  EXPECT_NE(complaint("local c c = function() coroutine.wrap(c)() end c()").find("overflow"),
            std::string::npos);
}

TEST(Sandbox, PrintingWithoutEndIsCutOff) {
  testing::internal::CaptureStderr();
  EXPECT_NE(complaint("print('\\27[2J first') while true do print('more and more') end").find("endless loop"),
            std::string::npos);
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_EQ(printed.substr(0, 20), "bad.lua: ?[2J first\n");
  EXPECT_LT(printed.size(), 200'000u);
  EXPECT_NE(printed.find("prints too much"), std::string::npos);
}

TEST(Sandbox, AScriptThatCannotBeReadIsNamed) {
  EXPECT_THROW(evaluate_file("/nowhere/scene.lua", {}, 0), SceneError);
  EXPECT_THROW(evaluate_file("/", {}, 0), SceneError);
}

// The helper, whatever it does. -----------------------------------------------------------------------------

HelperEnd shell(const std::string& commands) { return run_helper({"/bin/sh", commands, 10s, 100'000, {}}); }

TEST(Spawn, AHelperThatNeitherReadsNorEndsIsKilledInTime) {
  const std::string endless = "while :; do :; done\n";
  EXPECT_EQ(run_helper({"/bin/sh", endless, 100ms, 1000, {}}).kind, HelperEnd::Kind::timed_out);
  const std::string more_than_is_read = endless + std::string(10 << 20, 'x');
  EXPECT_EQ(run_helper({"/bin/sh", more_than_is_read, 100ms, 1000, {}}).kind, HelperEnd::Kind::timed_out);
  EXPECT_EQ(shell("while :; do echo more and more; done").kind, HelperEnd::Kind::output_too_long);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no child is left";
}

TEST(Spawn, HowAHelperEndedIsTold) {
  EXPECT_EQ(shell("echo abc").output, "abc\n");
  EXPECT_EQ(shell("exit 3").code, 3);
  EXPECT_EQ(shell("kill -9 $$").kind, HelperEnd::Kind::signalled);
  EXPECT_THROW(run_helper({"/nowhere/helper", "", 10s, 1000, {}}), std::system_error);
}

TEST(Spawn, AHelperHasItsThreeStreamsAndNothingElse) {
  EXPECT_EQ(shell("for i in 3 4 5 6 7 8 9; do [ -e /proc/$$/fd/$i ] && echo $i; done; true").output, "");
  EXPECT_EQ(run_helper({"/usr/bin/env", "", 10s, 1000, {}}).output, "");
  std::string talk;
  run_helper({"/bin/sh", "echo hello >&2", 10s, 1000, [&](std::string_view s) { talk += s; }});
  EXPECT_EQ(talk, "hello\n");
}

TEST(Spawn, AnswersThatNoSoundChildSendsAreRefused) {
  for (const std::string& bytes :
       {std::string(), std::string("\n"), std::string("{}\n"), std::string("[]\n"),
        std::string("{\"parameters\":[]}\nno scene"), std::string(3 << 20, '[') + "\n",
        encode_error("x").substr(1), std::string(10 << 20, ' ')})
    EXPECT_ANY_THROW(decode_reply(bytes));
  try {
    decode_reply(encode_error("circus.lua:12: torus"));
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(), "circus.lua:12: torus");
  }
}

}  // namespace
}  // namespace rayfarm
