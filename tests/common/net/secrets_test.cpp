#include "common/net/secrets.h"

#include <gtest/gtest.h>

#include <random>

namespace rayfarm {
namespace {

const std::string fingerprint(64, 'a');

TEST(Tokens, AreReadAsTheyAreWrittenAndAsPeopleTypeThem) {
  const Token token = new_token(fingerprint);
  const std::string text = text_of(token);
  EXPECT_EQ(text.size(), 47u) << "eight groups of five, seven hyphens";
  EXPECT_EQ(parse_token(text), token);
  std::string typed;
  for (const char c : text)
    if (c != '-') typed += c == '0' ? 'o' : c == '1' ? 'l' : static_cast<char>(std::tolower(c));
  EXPECT_EQ(parse_token(typed), token);
  EXPECT_EQ(token.farm, fingerprint.substr(0, 24));
  EXPECT_NE(new_token(fingerprint).secret, token.secret);
}

TEST(Tokens, WithAWrongLetterAreNoneAndAreNotRepeatedInTheMessage) {
  const std::string text = text_of(Token{std::string(24, 'a'), std::string(24, 'b')});
  int taken = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '-') continue;
    std::string wrong = text;
    wrong[i] = wrong[i] == '7' ? '8' : '7';
    try {
      parse_token(wrong);
      ++taken;
    } catch (const CodecError& error) {
      EXPECT_EQ(std::string(error.what()).find(text.substr(0, 5)), std::string::npos);
    }
  }
  EXPECT_LE(taken, 2) << "the checksum has 8 bits";
  for (const char* bad : {"", "hello", "U", "7", "-----", "!"})
    EXPECT_THROW(parse_token(bad), CodecError) << bad;
  EXPECT_THROW(parse_token(text + "7"), CodecError);
  EXPECT_THROW(parse_token(text.substr(6)), CodecError);
}

TEST(Base32, GivesBytesBack) {
  std::mt19937_64 random(1);
  for (std::size_t size = 0; size <= 50; size += 5) {
    Bytes bytes(size);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(from_base32(base32(bytes)), bytes);
  }
}

TEST(Secrets, AreComparedWhole) {
  EXPECT_TRUE(equal_in_constant_time("secret", "secret"));
  EXPECT_FALSE(equal_in_constant_time("secret", "secreT"));
  EXPECT_FALSE(equal_in_constant_time("secret", "secret2"));
  EXPECT_TRUE(equal_in_constant_time("", ""));
}

}  // namespace
}  // namespace rayfarm
