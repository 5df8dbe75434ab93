#include "master/http/request_target.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace rayfarm {
namespace {

TEST(RequestTarget, IsAPathAndAQuery) {
  const RequestTarget target = parse_target("/api/v1/jobs/7?after=3&wait=10&wait=20&flag");
  EXPECT_EQ(target.path, (std::vector<std::string>{"api", "v1", "jobs", "7"}));
  EXPECT_EQ(target.query.at("after"), "3");
  EXPECT_EQ(target.query.at("wait"), "20");
  EXPECT_EQ(target.query.at("flag"), "");
  EXPECT_TRUE(parse_target("/").path.empty());
  EXPECT_TRUE(parse_target("/?x=1").path.empty());
}

TEST(RequestTarget, AnyTextIsASegmentWhenEncoded) {
  for (const std::string name : {"pc 7", "a/b?c#d%", "\xc3\xa4", "..", "plain-._~"})
    EXPECT_EQ(parse_target("/workers/" + percent_encoded(name) + "/drain").path,
              (std::vector<std::string>{"workers", name, "drain"}));
}

TEST(RequestTarget, RefusesBrokenEscapesNulsAndWhatIsNoPath) {
  for (const std::string text : {"", "jobs", "http://elsewhere/", "/%", "/%4", "/%zz", "/%00", "/?a=%", "*"})
    EXPECT_THROW(parse_target(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace rayfarm
