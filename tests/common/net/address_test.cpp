#include "common/net/address.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

TEST(Address, IsReadAsPeopleWriteIt) {
  EXPECT_EQ(parse_address("lab7", 5411), (Address{"lab7", 5411}));
  EXPECT_EQ(parse_address("lab7.mff.cuni.cz:80", 5411), (Address{"lab7.mff.cuni.cz", 80}));
  EXPECT_EQ(parse_address("[::1]", 5411), (Address{"::1", 5411}));
  EXPECT_EQ(parse_address("[::1]:0", 5411), (Address{"::1", 0}));
}

TEST(Address, ReadsWhatItWrites) {
  for (const char* text : {"lab7:5411", "127.0.0.1:0", "[fe80::1%eth0]:65535"})
    EXPECT_EQ(text_of(parse_address(text, 1)), text);
}

TEST(Address, ThatIsBadIsNamed) {
  for (const char* text :
       {"", ":80", "lab7:", "lab7:80x", "lab7:65536", "lab7:-1", "::1", "[::1", "[::1]80", "a b", "a@b"}) {
    try {
      parse_address(text, 5411);
      ADD_FAILURE() << text;
    } catch (const AddressError& error) {
      EXPECT_NE(std::string(error.what()).find('"' + std::string(text) + '"'), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace rayfarm
