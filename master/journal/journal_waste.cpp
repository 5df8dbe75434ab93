// Deleting: what is dropped, what is lost, and the room that is left of it.
#include "master/journal/journal.h"
#include "master/journal/journal_state.h"
#include "master/journal/salvage.h"

namespace rayfarm {
namespace {

constexpr std::int64_t tiles_tidied = 64;   // at once: a few milliseconds
constexpr std::int64_t spare_pages = 2048;  // 8 MB, and a third of the file, stay to be used again
constexpr auto give_back_some = "PRAGMA incremental_vacuum(256)";  // pages: 1 MB, a few milliseconds

constexpr auto tiles_after = "SELECT id, body FROM tiles WHERE job = ? AND frame = ? AND id > ?";
constexpr auto tiles_after_from_the_end =
    "SELECT id, body FROM tiles WHERE job = ? AND frame = ? AND id > ? ORDER BY id DESC";

std::vector<std::int64_t> frames_of(Database& database, JobId job) {
  std::vector<std::int64_t> frames;
  const Query query = database.query("SELECT frame FROM frames WHERE job = ?", number_of(job));
  while (query->executeStep()) frames.push_back(query->getColumn(0));
  return frames;
}

}  // namespace

bool Journal::State::has_waste() { return database.query("SELECT 1 FROM waste")->executeStep(); }

void Journal::State::write(const PictureDropped& dropped) {
  drop_scene(dropped.id);
  drop_tiles(dropped.id);
  const Bytes row = seal(encode_row(dropped), key_of(dropped.id));
  database.run("UPDATE frames SET dropped = ? WHERE job = ? AND frame = ?", row, number_of(dropped.id.job),
               dropped.id.frame);
}

void Journal::State::write(const JobDropped& dropped) {
  for (const std::int64_t frame : frames_of(database, dropped.id)) {
    const FrameId id{dropped.id, static_cast<std::uint32_t>(frame)};
    drop_scene(id);
    drop_tiles(id);
  }
  database.run("DELETE FROM frames WHERE job = ?", number_of(dropped.id));
  database.run("DELETE FROM jobs WHERE id = ?", number_of(dropped.id));
  films.erase(dropped.id);
}

void Journal::State::write(const PassesLost& lost) {
  std::vector<std::int64_t> ids;
  find_lost(tiles_after, lost, tile_before, ids);
  for (const std::int64_t id : ids) delete_tile(lost.frame, id);
}

void Journal::State::forget(const PassesLost& lost) {
  is_tidy = false;
  std::vector<std::int64_t> ids;
  // From both ends, as far as what is damaged.
  if (!as_far_as_sound([&] { find_lost(tiles_after, lost, 0, ids); }))
    as_far_as_sound([&] { find_lost(tiles_after_from_the_end, lost, 0, ids); });
  for (const std::int64_t id : ids) as_far_as_sound([&] { delete_tile(lost.frame, id); });
}

void Journal::State::find_lost(const char* sql, const PassesLost& lost, std::int64_t after,
                               std::vector<std::int64_t>& ids) {
  const Query query = database.query(sql, number_of(lost.frame.job), lost.frame.frame, after);
  while (query->executeStep()) {
    const std::int64_t id = query->getColumn(0);
    const auto body = unseal(bytes_of(query->getColumn(1)), key_of(lost.frame, id));
    if (!body) continue;
    const TileCommitted commit = decode_tile(lost.frame, *body).commit;
    for (const Work& work : lost.lost)
      if (work.tile == commit.tile && (work.passes & commit.passes)) ids.push_back(id);
  }
}

/// Without its record nobody reads the pixels.
void Journal::State::delete_tile(FrameId frame, std::int64_t id) {
  database.run("DELETE FROM tiles WHERE job = ? AND frame = ? AND id = ?", number_of(frame.job), frame.frame,
               id);
  database.run("DELETE FROM pixels WHERE id = ?", id);
}

bool Journal::State::as_far_as_sound(const std::function<void()>& changes) const try {
  changes();
  return true;
} catch (const SQLite::Exception& error) {
  if (!is_damage(error)) throw;
  note_damage(file);
  return false;
}

void Journal::State::drop_scene(FrameId id) {
  is_tidy = false;
  database.run(
      "DELETE FROM blobs WHERE hash IN (SELECT hash FROM uses WHERE job = ?1 AND frame = ?2) AND NOT EXISTS "
      "(SELECT 1 FROM uses WHERE uses.hash = blobs.hash AND NOT (job = ?1 AND frame = ?2))",
      number_of(id.job), id.frame);
  database.run("DELETE FROM uses WHERE job = ? AND frame = ?", number_of(id.job), id.frame);
  database.run("UPDATE frames SET has_scene = 0 WHERE job = ? AND frame = ?", number_of(id.job), id.frame);
}

void Journal::State::drop_tiles(FrameId id) {
  is_tidy = false;
  database.run("INSERT OR IGNORE INTO waste VALUES (?, ?)", number_of(id.job), id.frame);
}

void Journal::tidy() try {
  if (state_->is_tidy) return;
  state_->is_tidy = !state_->has_waste() && !state_->has_spare_room();
  if (state_->is_tidy) return;
  bool was_untidy = true;
  state_->in_one([&] { was_untidy = state_->delete_waste(tiles_tidied) || state_->give_back_room(); });
  state_->is_tidy = !was_untidy;
} catch (const SQLite::Exception& error) {
  if (is_busy(error)) return;
  if (!is_damage(error)) state_->refuse_to_write(error);
  note_damage(state_->file);
  state_->is_tidy = true;  // what is left will be deleted when it is mended
}

void Journal::State::write(const SceneDropped& dropped) { drop_scene(dropped.id); }

bool Journal::State::has_spare_room() {
  SQLite::Database& sqlite = database.sqlite();
  const std::int64_t free = sqlite.execAndGet("PRAGMA freelist_count");
  return free > spare_pages && free * 3 > sqlite.execAndGet("PRAGMA page_count").getInt64();
}

bool Journal::State::give_back_room() {
  if (!has_spare_room()) return false;
  SQLite::Database& sqlite = database.sqlite();
  const std::int64_t all = sqlite.execAndGet("PRAGMA page_count");
  sqlite.exec(give_back_some);
  return sqlite.execAndGet("PRAGMA page_count").getInt64() < all;
}

bool Journal::State::delete_waste(std::int64_t tiles) {
  bool was_there = false;
  while (tiles > 0) {
    const Query oldest = database.query("SELECT job, frame FROM waste LIMIT 1");
    if (!oldest->executeStep()) break;
    was_there = true;
    const std::int64_t job = oldest->getColumn(0), frame = oldest->getColumn(1);
    database.run(
        "DELETE FROM pixels WHERE id IN (SELECT id FROM tiles WHERE job = ? AND frame = ? ORDER BY id LIMIT "
        "?)",
        job, frame, tiles);
    database.run(
        "DELETE FROM tiles WHERE job = ?1 AND frame = ?2 AND id IN "
        "(SELECT id FROM tiles WHERE job = ?1 AND frame = ?2 ORDER BY id LIMIT ?3)",
        job, frame, tiles);
    tiles -= database.sqlite().getChanges();
    if (tiles-- > 0) database.run("DELETE FROM waste WHERE job = ? AND frame = ?", job, frame);
  }
  return was_there;
}

void Journal::State::try_to_delete(std::int64_t tiles) {
  try {
    if (tiles > 0 && has_waste()) in_one([&] { delete_waste(tiles); });
  } catch (const SQLite::Exception&) {
    // tidy() will see it, too, and say so.
  }
}

}  // namespace rayfarm
