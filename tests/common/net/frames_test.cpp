#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>

#include "common/net/codec.h"
#include "tests/common/net/largest_allocation.h"
#include "tests/common/net/random_messages.h"

namespace rayfarm {
namespace {

using Header = std::span<const std::uint8_t, frame_header_size>;

void decode_whole(ByteView frame, ToWorker& message) {
  if (frame.size() < frame_header_size) throw CodecError("no whole header");
  message = decode_to_worker(decode_frame_header_to_worker(frame.first<frame_header_size>()),
                             frame.subspan(frame_header_size));
}
void decode_whole(ByteView frame, ToMaster& message) {
  if (frame.size() < frame_header_size) throw CodecError("no whole header");
  message = decode_to_master(decode_frame_header_to_master(frame.first<frame_header_size>()),
                             frame.subspan(frame_header_size));
}

/// CodecError is the only way not to be a value.
template <class Message>
bool is_taken(ByteView frame) {
  Message message;
  try {
    decode_whole(frame, message);
  } catch (const CodecError&) {
    return false;
  }
  return true;
}

/// A frame whose checksum is right whatever its payload says.
void repair_checksum(Bytes& frame) {
  const auto crc = crc32_z(0, frame.data() + frame_header_size, frame.size() - frame_header_size);
  for (int i = 0; i < 4; ++i) frame[12 + i] = static_cast<std::uint8_t>(crc >> 8 * i);
}

// What holds in both directions.
template <class Message>
std::vector<Message> random_messages(std::mt19937_64& random) {
  if constexpr (std::is_same_v<Message, ToWorker>)
    return random_to_worker(random);
  else
    return random_to_master(random);
}

template <class Message>
class Frames : public testing::Test {};
using Directions = testing::Types<ToWorker, ToMaster>;
TYPED_TEST_SUITE(Frames, Directions);

TYPED_TEST(Frames, DecodeToWhatWasEncoded) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 50; ++round)
    for (const TypeParam& message : random_messages<TypeParam>(random)) {
      const Bytes frame = encode(message);
      TypeParam decoded;
      decode_whole(frame, decoded);
      EXPECT_EQ(decoded.index(), message.index());
      EXPECT_EQ(encode(decoded), frame);  // NaNs differ from themselves, their bits do not
    }
}

TYPED_TEST(Frames, CutAnywhereAreRefused) {
  std::mt19937_64 random(2);
  for (const TypeParam& message : random_messages<TypeParam>(random)) {
    const Bytes frame = encode(message);
    for (std::size_t size = 0; size < std::min<std::size_t>(frame.size(), 3000); ++size) {
      Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(is_taken<TypeParam>(cut));
    }
  }
}

TYPED_TEST(Frames, CutWithARightChecksumAreRefusedButForTheBytesOfScenesAndAssets) {
  std::mt19937_64 random(3);
  for (const TypeParam& message : random_messages<TypeParam>(random)) {
    const bool is_data =
        std::is_same_v<TypeParam, ToWorker> && (message.index() == 2 || message.index() == 9);
    const Bytes frame = encode(message);
    const std::size_t end = is_data ? frame_header_size + 69 : std::min<std::size_t>(frame.size(), 3000);
    for (std::size_t size = frame_header_size; size < end; ++size) {
      Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
      const std::size_t payload = size - frame_header_size;
      for (int i = 0; i < 4; ++i) cut[8 + i] = static_cast<std::uint8_t>(payload >> 8 * i);
      repair_checksum(cut);
      EXPECT_FALSE(is_taken<TypeParam>(cut)) << "type " << message.index() << " cut at " << size;
    }
  }
}

TYPED_TEST(Frames, WithAnyFlippedBitOfThePayloadAreRefused) {
  std::mt19937_64 random(4);
  for (const TypeParam& message : random_messages<TypeParam>(random)) {
    Bytes frame = encode(message);
    if (frame.size() > 5000) continue;
    for (std::size_t bit = 8 * frame_header_size; bit < 8 * frame.size(); ++bit) {
      frame[bit / 8] ^= 1 << bit % 8;
      EXPECT_FALSE(is_taken<TypeParam>(frame));
      frame[bit / 8] ^= 1 << bit % 8;
    }
  }
}

// The checksum is of the payload alone. What it cannot see, a type that became another one, the payload tells: of no two
// types that differ in one bit does one read what the other has said.
TYPED_TEST(Frames, WithAnyFlippedBitOfTheHeaderAreRefused) {
  std::mt19937_64 random(7);
  const std::size_t empty_list = encode(ToWorker{Revoke{}}).size();
  for (int round = 0; round < 50; ++round)
    for (const TypeParam& message : random_messages<TypeParam>(random)) {
      Bytes frame = encode(message);
      if (frame.size() == empty_list) continue;  // is never sent: it says nothing
      for (std::size_t bit = 0; bit < 8 * frame_header_size; ++bit) {
        frame[bit / 8] ^= 1 << bit % 8;
        EXPECT_FALSE(is_taken<TypeParam>(frame)) << "type " << message.index() << ", bit " << bit;
        frame[bit / 8] ^= 1 << bit % 8;
      }
    }
}

TYPED_TEST(Frames, DamagedWithARightChecksumAreRefusedOrSaneAndTakeLittleMemory) {
  std::mt19937_64 random(5);
  for (const TypeParam& message : random_messages<TypeParam>(random)) {
    Bytes frame = encode(message);
    take_largest_allocation();
    for (std::size_t bit = 0; bit < 8 * std::min<std::size_t>(frame.size(), 500); ++bit) {
      Bytes flipped = frame;
      flipped[bit / 8] ^= 1 << bit % 8;
      if (bit >= 8 * frame_header_size) repair_checksum(flipped);
      TypeParam decoded;
      try {
        decode_whole(flipped, decoded);
      } catch (const CodecError&) {
        continue;
      }
      EXPECT_NO_THROW(encode(decoded));
    }
    EXPECT_LT(take_largest_allocation(), 1u << 20);
  }
}

TYPED_TEST(Frames, OfRandomBytesAreRefusedOrSaneAndTakeLittleMemory) {
  std::mt19937_64 random(6);
  take_largest_allocation();
  for (int round = 0; round < 20'000; ++round) {
    Bytes payload(random() % 200);
    for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random() % 4 ? random() : 0);
    const FrameHeader header{static_cast<std::uint16_t>(random() % 10),
                             static_cast<std::uint32_t>(payload.size()),
                             static_cast<std::uint32_t>(crc32_z(0, payload.data(), payload.size()))};
    try {
      if constexpr (std::is_same_v<TypeParam, ToWorker>)
        decode_to_worker(header, payload);
      else
        decode_to_master(header, payload);
    } catch (const CodecError&) {}
  }
  EXPECT_LT(take_largest_allocation(), 1u << 20);
}

std::string error_of(const Bytes& header) {
  try {
    decode_frame_header_to_worker(Header(header));
  } catch (const CodecError& error) {
    return error.what();
  }
  return "";
}

TEST(FrameHeaders, SayWhatIsWrong) {
  Bytes header = encode(ToWorker{Heartbeat{}});
  header.resize(frame_header_size);
  Bytes http = header, newer = header, unknown = header, huge = header;
  http[0] = 'G';
  newer[4] = 2;
  unknown[6] = 99;
  huge[11] = 0x40;
  EXPECT_EQ(error_of(header), "");
  EXPECT_EQ(error_of(http), "the peer does not speak rayfarm's protocol");
  EXPECT_EQ(error_of(newer), "the peer's frames have version 2, ours 1");
  EXPECT_EQ(error_of(unknown), "there is no message of type 99");
  EXPECT_EQ(error_of(huge), "a message of type 7 announces 1073741825 bytes, the limit is 8192");
}

TEST(Messages, OfALaterProtocolCanStillSayHello) {
  Hello hello{{protocol_version + 1, protocol_version, 7}, "9.9", "future", "cpu", 4, std::string(64, 'f')};
  Bytes frame = encode(ToMaster{hello});
  frame.push_back(42);  // what we cannot know yet
  ++frame[8];
  repair_checksum(frame);
  ToMaster decoded;
  decode_whole(frame, decoded);
  EXPECT_EQ(std::get<Hello>(decoded), hello);
}

TEST(Messages, WithTextThatCannotBeShownAreNotSent) {
  EXPECT_THROW(encode(ToMaster{Hello{{}, "0", "bell\a", "", 1, std::string(64, 'e')}}), CodecError);
  EXPECT_THROW(encode(ToMaster{Hello{{}, "0", "half \xC3", "", 1, std::string(64, 'e')}}), CodecError);
  EXPECT_THROW(encode(ToMaster{Goodbye{std::string(5000, 'x')}}), CodecError);
}

TEST(Messages, WithSettingsThatCannotBeRenderedAreRefused) {
  RenderSettings settings;
  settings.width = 0;
  EXPECT_THROW(encode(ToWorker{FrameStart{JobId{1}, std::string(64, 'a'), settings}}), CodecError);
}

}  // namespace
}  // namespace rayfarm
