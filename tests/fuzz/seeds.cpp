// Writes the seeds that are no text into tests/fuzz/corpus, one folder a door: small and sound, so that a fuzzer begins
// behind the first checks. To be run again when a format changes.
//   fuzz_seeds FOLDER
#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <random>

#include "common/net/certificates.h"
#include "common/net/compress.h"
#include "common/net/little_endian.h"
#include "master/files/image_file.h"
#include "master/journal/journal.h"
#include "master/journal/rows.h"
#include "master/script/exchange.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

std::filesystem::path corpus;

template <class Content>
void write(const std::string& door, const std::string& name, const Content& content) {
  std::filesystem::create_directories(corpus / door);
  std::ofstream(corpus / door / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
}

/// Behind the byte that chooses the reader.
template <class Content>
void write_choice(const std::string& door, char choice, const std::string& name, const Content& content) {
  write(door, name, std::string(1, choice) + std::string(content.begin(), content.end()));
}

std::string decompressed(const Bytes& bytes) {
  DecompressedSource source(bytes, 1 << 20);
  return {std::istreambuf_iterator<char>(&source), {}};
}

// Scenes and assets. ---------------------------------------------------------------------------------------

const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
                               {},
                               {},
                               {},
                               {}};
const Image image{2, 1, std::vector<std::uint8_t>{1, 2, 3, 255, 254, 253}};

void write_scenes() {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Scene scene = random_special_scene(seed);
    scene.nodes.front().name = "M\xc3\xbcllers node";
    const Bytes bytes = encode_scene(scene);
    write("scene", "content_" + std::to_string(seed), decompressed(bytes));
    if (seed == 1) write("scene", "whole", bytes);
  }
}

void write_assets() {
  const BezierGrid patch{1, 1, [] {
                           std::vector<Vec3d> points;
                           for (int i = 0; i < 16; ++i)
                             points.push_back({i % 4 / 3.0, i / 4 / 3.0, i % 3 / 4.0});
                           return points;
                         }()};
  write("asset", "mesh", decompressed(*asset_data(tetrahedron).bytes));
  write("asset", "bezier", decompressed(*asset_data(patch).bytes));
  write("asset", "image", decompressed(*asset_data(image).bytes));
  write("asset", "linear_image",
        decompressed(*asset_data(Image{1, 1, std::vector<float>{0, 0.5f, 9}}).bytes));
  write("asset", "whole", *asset_data(tetrahedron).bytes);
}

// Pixels. --------------------------------------------------------------------------------------------------

PassImage pass_of(const Tile& tile, int pass) {
  PassImage made{pass, std::vector<float>(3 * pixel_count(tile, pass)), {}};
  for (std::size_t i = 0; i < made.rgb.size(); ++i) made.rgb[i] = static_cast<float>(i) / 8;
  return made;
}

void write_pixels() {
  Film film({70, 20});
  film.put(0, pass_of(tile_at(film.size(), 0), 0));
  film.put(1, pass_of(tile_at(film.size(), 1), 3));
  write_choice("pixels", 0, "film", encode_film(film));
  Bytes packed;
  append_u16(packed, 6);
  pack_floats(std::vector<float>{1, -0.0f, 3e38f, 1e-40f, 0.1f, 2}, packed);
  write_choice("pixels", 1, "packed", packed);
}

// The journal. ---------------------------------------------------------------------------------------------

JobAdded job() {
  JobAdded added{JobId{7}, {}, FarmTime(5)};
  added.spec.name = "small", added.spec.output = "small.exr", added.spec.key = "monday";
  added.spec.settings.width = 100, added.spec.settings.height = 80;
  added.spec.parameters = {{"depth", "6"}};
  added.spec.frames = FrameRange{0, 4, 2};
  return added;
}

constexpr FrameId frame{JobId{7}, 0};

TileCommitted commit() {
  TileCommitted made{frame, 0, 0b0001, "lab7", FarmTime(6), FarmTime(7), {1, 2, 3, 4, 5, 6, 7, 8}, {}};
  made.images = {pass_of(tile_at({100, 80}, 0), 0)};
  return made;
}

JobChanged change() {
  JobChanged changed{JobId{7}, JobState::failed, 60, "too large", "monday", 1, FarmTime(9)};
  changed.tiles_doubled = 2;
  return changed;
}

FrameAdded first_frame() {
  const auto scene = std::make_shared<const Bytes>(encode_scene(random_scene(1)));
  return {frame, sha256_hex(*scene), scene, {asset_data(tetrahedron)}};
}

void write_rows() {
  write_choice("rows", 0, "job", encode_row(job()));
  write_choice("rows", 1, "change", encode_row(change()));
  write_choice("rows", 2, "frame", encode_row(FrameRow{std::string(64, 'a'), {std::string(64, 'b')}}));
  write_choice("rows", 3, "dropped",
               encode_row(PictureDropped{frame, 8000, {1, 2, 3}, FarmTime(4), FarmTime(5)}));
  const Bytes tile = encode_row(commit(), 1, std::array<std::uint64_t, 2>{2, 3});
  write_choice("rows", 4, "tile", tile);
  Bytes with_pixels;
  append_u16(with_pixels, static_cast<std::uint16_t>(tile.size()));
  for (const Bytes& part : {tile, pack_pixels(commit())})
    with_pixels.insert(with_pixels.end(), part.begin(), part.end());
  write_choice("rows", 5, "tile_with_pixels", with_pixels);
}

void write_journal() {
  const std::filesystem::path file = corpus / "journal" / "whole";
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::remove(file);
  {
    Journal journal(file);
    journal.read();
    const std::vector<FarmRecord> records{{WorkerNamed{"lab7"}},
                                          {WorkerKnown{"certificate 1", "lab7", false, {}}},
                                          {job()},
                                          {first_frame()},
                                          {FrameStarted{frame, FarmTime(6)}},
                                          {commit()},
                                          {JobChanged{JobId{7}, JobState::running, 50, "", "monday", 0, {}}}};
    while (!journal.write(records)) {}
  }
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
  for (const char* smaller : {"PRAGMA journal_mode = DELETE", "PRAGMA page_size = 512", "VACUUM"})
    database.exec(smaller);
  std::filesystem::remove(file.string() + "-mark");
}

// Others. --------------------------------------------------------------------------------------------------

void write_replies() {
  Scene scene = random_scene(1);
  const ScriptParameter depth{"depth", "int", "5", "recursion depth", {}, 1, 9};
  write("script_reply", "result", encode_reply({scene, {asset_data(tetrahedron)}, {depth}}));
  write("script_reply", "error", encode_error("scene.lua:3: unknown key"));
  write("script_reply", "wish", encode_wish({"bunny.ply"}));
}

void write_certificates() {
  const Identity authority = new_authority(WallTime{});
  const std::string request = certificate_request(new_key());
  write("certificate", "request", request);
  write("certificate", "certificate",
        issue(authority, request, {PeerRole::master, "pc", {"pc.lab", "10.0.0.1"}},
              {WallTime{}, WallTime{} + std::chrono::hours(1)}));
}

void write_images() {
  const Picture picture{{2, 1}, {0, 0.5f, 1, 0.25f, 9, -1}, {}};
  write_choice("image", 0, "png", png_bytes(picture));
  write_choice("image", 2, "exr", exr_bytes(picture));
  const std::string radiance = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X ", pixel = "\n\x80\x40\x20\x81";
  write_choice("image", 3, "hdr", radiance + "1" + pixel);
  write_choice("image", 3, "wide_hdr", radiance + "15466504" + pixel);
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  using namespace rayfarm;
  if (argc != 2) return std::fputs("usage: fuzz_seeds FOLDER\n", stderr), 2;
  corpus = argv[1];
  write_scenes();
  write_assets();
  write_pixels();
  write_rows();
  write_journal();
  write_replies();
  write_certificates();
  write_images();
}
