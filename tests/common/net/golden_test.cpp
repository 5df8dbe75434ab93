// Frames as each released protocol had them on the wire: what was once understood stays understood, and is still said
// in the same bytes while the protocol is spoken. A new protocol gets a folder of its own; an old one never changes, but
// those who can more than it asks for may have more messages, whose frames come to its own.
//   golden_test --gtest_also_run_disabled_tests --gtest_filter='*AreWritten*'     writes those of the newest
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "common/net/codec.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

std::filesystem::path file_of(const std::string& name) {
  return std::filesystem::path(RAYFARM_SOURCE_DIR "/tests/common/net/golden") /
         ("protocol_" + std::to_string(protocol_version)) / name;
}

Bytes golden(const std::string& name) {
  const std::string content = content_of(file_of(name));
  return {content.begin(), content.end()};
}

const std::string hash(64, 'a');
const SharedBytes bytes = std::make_shared<const Bytes>(Bytes{1, 2, 3, 250});

/// Text that is longer in bytes than in letters, numbers with all their bytes.
const std::map<std::string, ToMaster> to_master{
    {"hello", Hello{{4, 4, 0x0102030405060708},
                    "1.0.0",
                    "Müllers PC",
                    "Some CPU @ 3 GHz",
                    8,
                    std::string(64, 'e'),
                    0x1122334455667788}},
    {"result", Result{LeaseId{0x1122334455667788},
                      JobId{7},
                      3,
                      42,
                      {{0, {0.5f, -0.0f, 1e-40f}, {1, 2, 3, 4, 5, 6, 7, 8}}, {3, {1, 2, 3, 4, 5, 6}, {}}},
                      0.25}},
    {"give_back", GiveBack{{LeaseId{1}, LeaseId{0x1122334455667788}}, "too large for this PC"}},
    {"holds", Holds{{{{LeaseId{0x1122334455667788}, JobId{7}, 3, 42, 0b1010}, true},
                     {{LeaseId{1}, JobId{7}, 3, 43, 0b1111}, false}}}},
    {"heartbeat", Heartbeat{}},
    {"goodbye", Goodbye{"the worker stops"}},
    {"piece_result",
     PieceResult{{LeaseId{0x1122334455667788},
                  JobId{7},
                  3,
                  42,
                  {{0, {0.5f, -0.0f, 1e-40f}, {1, 2, 3, 4, 5, 6, 7, 8}}, {3, {1, 2, 3, 4, 5, 6}, {}}},
                  0.25},
                 {0x0102, 0x0304, 0x0112, 0x0314}}},
    {"join", Join{{4, 4, 1}, "1.0.0", "0123456789abcdef01234567", "lab7", {'P', 'E', 'M', 0, 255}}},
};

const std::map<std::string, ToWorker> to_worker{
    {"welcome", Welcome{"Müllers PC-2", {4, 4, 5}}},
    {"refused", Refused{"install the same version on both PCs"}},
    {"scene_data", SceneData{hash, bytes}},
    {"frame_start",
     FrameStart{JobId{7},
                hash,
                {640, 480, 16, SamplerKind::adapt1, 0x1122334455667788, 3, 12, 0.05, true, false, true},
                {hash, std::string(64, 'b')}}},
    {"assignment", Assignment{LeaseId{0x1122334455667788}, JobId{7}, 3, 42, 0b1010}},
    {"piece_assignment", PieceAssignment{{LeaseId{0x1122334455667788}, JobId{7}, 3, 42, 0b1010},
                                         {0x0102, 0x0304, 0x0112, 0x0314}}},
    {"revoke", Revoke{{LeaseId{1}, LeaseId{2}}}},
    {"frame_end", FrameEnd{JobId{7}, 3}},
    {"unneeded", Unneeded{{LeaseId{1}, LeaseId{0x1122334455667788}}}},
    {"heartbeat_to_worker", Heartbeat{}},
    {"goodbye_to_worker", Goodbye{"the master stops"}},
    {"asset_data", AssetData{hash, bytes}},
    {"asset_end", AssetEnd{{hash}}},
    {"paired", Paired{{'P', 'E', 'M', 0, 255}}},
};

ToMaster decoded_to_master(ByteView frame) {
  return decode_to_master(decode_frame_header_to_master(frame.first<frame_header_size>()),
                          frame.subspan(frame_header_size));
}
ToWorker decoded_to_worker(ByteView frame) {
  return decode_to_worker(decode_frame_header_to_worker(frame.first<frame_header_size>()),
                          frame.subspan(frame_header_size));
}

TEST(GoldenFrames, AreOfEachMessage) {
  EXPECT_EQ(to_master.size(), std::variant_size_v<ToMaster>);
  EXPECT_EQ(to_worker.size(), std::variant_size_v<ToWorker>);
}

TEST(GoldenFrames, AreWhatIsStillSaid) {
  for (const auto& [name, message] : to_master) {
    if (name == "result" || name == "piece_result") continue;  // zstd may pack in another way
    EXPECT_EQ(encode(message), golden(name)) << name;
  }
  for (const auto& [name, message] : to_worker) EXPECT_EQ(encode(message), golden(name)) << name;
}

TEST(GoldenFrames, AreStillUnderstood) {
  for (const auto& [name, message] : to_master) {
    ASSERT_FALSE(golden(name).empty()) << name;
    EXPECT_EQ(encode(decoded_to_master(golden(name))), encode(message)) << name;
  }
  for (const auto& [name, message] : to_worker) {
    ASSERT_FALSE(golden(name).empty()) << name;
    EXPECT_EQ(encode(decoded_to_worker(golden(name))), encode(message)) << name;
  }
}

// Protocol 2 was never released, but is the shape that Hello began with: the frame of a worker of that time.
TEST(GoldenFrames, OfAnOlderHelloAreReadFarEnoughToBeRefused) {
  const Bytes payload = golden("../protocol_2/hello");
  const Hello hello = std::get<Hello>(decoded_to_master(payload));
  EXPECT_EQ(hello.versions, (Versions{2, 2, 0}));
  EXPECT_EQ(hello.software, "0.1.0");
  EXPECT_EQ(hello.name, "lab7");
  EXPECT_FALSE(common_versions(hello.versions, {}));
}

void write(const std::string& name, const Bytes& frame) {
  std::filesystem::create_directories(file_of(name).parent_path());
  put_content(file_of(name), std::string(frame.begin(), frame.end()));
}
TEST(GoldenFrames, DISABLED_AreWrittenForANewProtocol) {
  for (const auto& [name, message] : to_master) write(name, encode(message));
  for (const auto& [name, message] : to_worker) write(name, encode(message));
}

TEST(Versions, AreTheNewestThatBothSpeak) {
  EXPECT_EQ(common_versions({5, 3, 0b110}, {4, 2, 0b011}), (Versions{4, 4, 0b010}));
  EXPECT_EQ(common_versions({4, 2, 0}, {5, 4, 0}), (Versions{4, 4, 0}));
  EXPECT_EQ(common_versions({3, 2, 0}, {5, 4, 0}), std::nullopt);
  EXPECT_EQ(common_versions({5, 4, 0}, {3, 2, 0}), std::nullopt);
}

}  // namespace
}  // namespace rayfarm
