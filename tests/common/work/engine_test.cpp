#include "common/work/engine.h"

#include <gtest/gtest.h>

#include <future>

namespace rayfarm {
namespace {

TEST(Engine, HasOneFingerprintWhoeverAsksFirst) {
  auto first = std::async(std::launch::async, engine_fingerprint),
       second = std::async(std::launch::async, engine_fingerprint);
  const std::string fingerprint = engine_fingerprint();
  EXPECT_EQ(first.get(), fingerprint);
  EXPECT_EQ(second.get(), fingerprint);
  EXPECT_EQ(fingerprint.size(), 64u);
  EXPECT_EQ(fingerprint.find_first_not_of("0123456789abcdef"), std::string::npos);
}

}  // namespace
}  // namespace rayfarm
