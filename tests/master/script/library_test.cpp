// The standard functions: what is there gives the same everywhere, what reaches out is not there.
#include <gtest/gtest.h>

#include "common/math/deterministic.h"
#include "master/script/lua_library.h"
#include "tests/master/script/script_support.h"

namespace rayfarm {
namespace {

TEST(Library, MathIsDeterministic) {
  namespace d = deterministic;
  EXPECT_EQ(number("math.sin(1.25)"), d::sin(1.25));
  EXPECT_EQ(number("math.cos(1.25)"), d::cos(1.25));
  EXPECT_EQ(number("math.tan(1.25)"), d::tan(1.25));
  EXPECT_EQ(number("math.asin(0.3)"), d::asin(0.3));
  EXPECT_EQ(number("math.acos(0.3)"), d::acos(0.3));
  EXPECT_EQ(number("math.atan(3)"), d::atan(3));
  EXPECT_EQ(number("math.atan(3, -4)"), d::atan2(3, -4));
  EXPECT_EQ(number("math.exp(3.3)"), d::exp(3.3));
  EXPECT_EQ(number("math.log(3.3)"), d::log(3.3));
  EXPECT_EQ(number("math.log(8, 2)"), 3);
  EXPECT_EQ(number("math.log(1000, 10)"), 3);
  EXPECT_EQ(number("math.log(81, 3)"), d::log(81) / d::log(3));
  EXPECT_EQ(number("math.sqrt(2)"), std::sqrt(2.0));
}

TEST(Library, ThePowerOperatorIsOurs) {
  // Over enough arguments the C library would differ from ours in some last bit.
  const Scene scene = run(R"(
    local sum, x = {}, 1.37
    for i = 1, 1000 do sum[i] = point{ at = {(0.01 + i * 0.173) ^ (i * 0.0137 - 5), 0, 0} } end
    return scene{ root = sphere{}, lights = sum })")
                          .scene;
  for (int i = 1; i <= 1000; ++i)
    EXPECT_EQ(std::get<PointLight>(scene.lights[static_cast<std::size_t>(i) - 1]).at.x,
              deterministic::pow(0.01 + i * 0.173, i * 0.0137 - 5));
}

TEST(Library, RandomNumbersAreTheSameInEachRun) {
  const double first = number("math.random()");
  EXPECT_EQ(number("math.random()"), first);
  EXPECT_NE(number("math.random()", "math.random()"), first);
  EXPECT_EQ(number("math.random()", "math.randomseed(7)"),
            number("math.random()", "math.random() math.randomseed(7)"));
  EXPECT_NE(complaint("math.randomseed()"), "");
}

TEST(Library, PairsGoInOrder) {
  const std::string table =
      "local t = { z = 1, a = 2, [10] = 3, [2] = 4, [2.5] = 5, [-1] = 6, [true] = 7, B = 8, aa = 9, 20 "
      "}\nlocal s = ''\n";
  const std::string wanted = "-1 1 2 2.5 10 B a aa z true ";
  EXPECT_EQ(text("s", table + "for k in pairs(t) do s = s .. tostring(k) .. ' ' end"), wanted);
  EXPECT_EQ(
      text("s", table + "local k = next(t) while k ~= nil do s = s .. tostring(k) .. ' ' k = next(t, k) end"),
      wanted);
  EXPECT_EQ(text("s", table + "for k, v in next, t do s = s .. tostring(k) .. ' ' end"), wanted);
  EXPECT_EQ(text("s", table + "for k in pairs(t) do s = s .. tostring(k) t[10] = nil t.new = 1 end"),
            "-1122.5Baaaztrue");
  EXPECT_EQ(text("tostring(next({}))"), "nil");
  EXPECT_EQ(
      complaint("\nfor k in pairs{ [sphere{}] = 1 } do end"),
      "test.lua:2: pairs: the table has a node as a key; only numbers, strings and booleans have an order");
}

TEST(Library, SortIsStableAndSurvivesAnyComparison) {
  EXPECT_EQ(text("table.concat(t, ' ')", "local t = { 5, 3, 9, 1, 1, 7 } table.sort(t)"), "1 1 3 5 7 9");
  EXPECT_EQ(text("table.concat(t, ' ')",
                 "local t = { 'b1', 'a1', 'b2', 'a2' } table.sort(t, function(a, b) return a:sub(1, 1) < "
                 "b:sub(1, 1) end)"),
            "a1 a2 b1 b2");
  EXPECT_EQ(number("t[1] + t[1000]",
                   "local t = {} for i = 1, 1000 do t[i] = i * 7919 % 1000 end table.sort(t, function(a, b) "
                   "return a > b end)"),
            999);
  EXPECT_EQ(number("#t",
                   "local t = {} for i = 1, 500 do t[i] = i end table.sort(t, function() return "
                   "math.random() < 0.5 end)"),
            500);
  EXPECT_NE(complaint("table.sort{ 1, 'a' }").find("attempt to compare"), std::string::npos);
}

TEST(Library, NoAddressIsSeen) {
  EXPECT_EQ(text("tostring({}) .. tostring(print) .. tostring(sphere{}) .. tostring(1.5)"),
            "tablefunctionnode1.5");
  EXPECT_EQ(text("string.format('%s %d %s', {}, 3, print)"), "table 3 function");
  for (const char* form : {"%p", "%%%p", "%d %-20p"})
    EXPECT_NE(complaint("string.format('" + std::string(form) + "', 1, 'x')").find("%p is not available"),
              std::string::npos);
  EXPECT_EQ(text("string.format('%%p %5.1f%%', 2)"), "%p   2.0%");
  EXPECT_EQ(complaint("\nstring.format('%d', 'x')"),
            "test.lua:2: bad argument #2 to '?' (number expected, got string)");
  EXPECT_EQ(text("tostring(setmetatable({}, { __tostring = function() return 'mine' end }))"), "mine");
}

TEST(Library, WhatReachesOutIsNotThere) {
  for (const std::string& name : removed_names())
    if (name.find('.') == std::string::npos) {
      EXPECT_EQ(complaint(name + "()"), "test.lua:1: '" + name + "' is not available in a scene script");
    } else {
      EXPECT_EQ(text("tostring(" + name + ")"), "nil");
    }
  EXPECT_NE(complaint("setmetatable({}, { __gc = function() end })").find("__gc is not available"),
            std::string::npos);
  EXPECT_EQ(complaint("setmetatable(_G, {})"), "test.lua:1: cannot change a protected metatable");
  EXPECT_EQ(text("tostring(getmetatable(sphere{}))"), "false");
}

TEST(Library, TheRestOfLuaIsThere) {
  EXPECT_EQ(text("('x'):rep(3) .. utf8.char(65) .. select('#', 1, 2) .. #table.pack(1, 2, 3)"), "xxxA23");
  EXPECT_EQ(text("tostring(pcall(error, 'x'))"), "false");
  EXPECT_EQ(
      number("f() + f()", "local f = coroutine.wrap(function() coroutine.yield(1) coroutine.yield(2) end)"),
      3);
  EXPECT_EQ(text("g()", "function g() return 'global functions may be defined' end"),
            "global functions may be defined");
}

}  // namespace
}  // namespace rayfarm
