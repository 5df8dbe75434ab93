#include "master/http/submission.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "tests/support/test_submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

JobSpec job_spec(const json& body) {
  AssetStore none;
  return rayfarm::job_spec(body, none);
}

TEST(Submission, ArrivesAsItWasSent) {
  JobSpec sent = small_job();
  sent.priority = 99, sent.hold = true, sent.key = "k";
  sent.verification = Audit{0.125};
  const JobSpec come = job_spec(parse_json(to_json(sent).dump()));
  EXPECT_EQ(come.name, sent.name);
  EXPECT_EQ(come.output, sent.output);
  EXPECT_EQ(come.scene_hash, sent.scene_hash);
  EXPECT_EQ(*come.scene_bytes, *sent.scene_bytes);
  EXPECT_EQ(come.settings, sent.settings);
  EXPECT_EQ(come.priority, sent.priority);
  EXPECT_EQ(come.hold, sent.hold);
  EXPECT_EQ(come.key, sent.key);
  EXPECT_EQ(come.verification, sent.verification);
}

void expect_refused(const char* member, const json& value) {
  json body = to_json(small_job());
  body[member] = value;
  EXPECT_ANY_THROW(job_spec(body)) << member << ": " << value;
}

TEST(Submission, WhatIsWrongIsRefused) {
  expect_refused("priority", 100);
  expect_refused("priority", -1);
  expect_refused("priority", "high");
  expect_refused("hold", "yes");
  expect_refused("verify", "audit=2");
  expect_refused("verify", 2);
  expect_refused("name", 7);
  expect_refused("name", std::string(1001, 'a'));
  expect_refused("settings", {{"width", 0}});
  expect_refused("settings", 7);
  expect_refused("scene", "not base64!");
  expect_refused("scene", "aGVsbG8=");
  expect_refused("scene", json());
  expect_refused("outptu", "a.exr");
  EXPECT_THROW(job_spec(json::object()), ApiError);
}

TEST(Submission, ANameIsOneLineForItGoesIntoTheLog) {
  for (const char* name : {"name", "output", "key"})
    for (const char* text : {"a\njob 7 (homework) cancelled", "a\tb", "\x1b[2J", "a\u2028b"}) {
      json body = to_json(small_job());
      body[name] = text;
      try {
        job_spec(body);
        ADD_FAILURE() << name << " may be " << text;
      } catch (const ApiError& error) {
        EXPECT_EQ(error.status, 422u);
      }
    }
}

TEST(Submission, ASceneThatCannotBeRenderedIsRefusedAtTheDoor) {
  Scene scene = simple_scene();
  scene.nodes.clear();
  json body = to_json(small_job());
  body["scene"] = base64(encode_scene(scene));
  EXPECT_ANY_THROW(job_spec(body));
}

TEST(ParseJson, RefusesWhatWouldTakeMuchMoreMemoryThanItsText) {
  EXPECT_THROW(parse_json("{\"a\":" + std::string(1'000'000, '[')), ApiError);
  std::string many = "{\"a\":[0";
  for (int i = 0; i < 100'000; ++i) many += ",0";
  EXPECT_THROW(parse_json(many + "]}"), ApiError);
  EXPECT_THROW(parse_json("[]"), ApiError);
  EXPECT_THROW(parse_json("{"), ApiError);
  EXPECT_THROW(parse_json("{\"a\": \"\xff\"}"), ApiError);
}

}  // namespace
}  // namespace rayfarm
