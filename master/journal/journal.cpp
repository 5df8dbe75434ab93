// Writing.
#include "master/journal/journal.h"

#include <algorithm>
#include <fstream>

#include "master/journal/journal_state.h"
#include "master/journal/salvage.h"

namespace rayfarm {
namespace {

constexpr std::int64_t tiles_tidied = 64;   // at once: a few milliseconds
constexpr std::int64_t spare_pages = 2048;  // 8 MB, and a third of the file, stay to be used again
constexpr auto give_back_some = "PRAGMA incremental_vacuum(256)";  // pages: 1 MB, a few milliseconds
constexpr auto what_to_do = "; make room there or mend the disk, then resume the job";
constexpr auto what_if_damaged = "; start the master again: what can be read is then written anew";

std::vector<std::int64_t> frames_of(Database& database, JobId job) {
  std::vector<std::int64_t> frames;
  const Query query = database.query("SELECT frame FROM frames WHERE job = ?", number_of(job));
  while (query->executeStep()) frames.push_back(query->getColumn(0));
  return frames;
}

}  // namespace

Journal::Journal(const std::filesystem::path& file) try {
  if (std::filesystem::exists(note_of_damage(file))) mended_ = salvage(file);
  state_ = std::make_unique<State>(file);
  try {
    state_->begin();
  } catch (const SQLite::Exception& error) {
    if (!is_damage(error) || mended_) throw;
    mend();
  }
} catch (const SQLite::Exception& error) {
  throw JournalError("the journal " + file.string() + " cannot be used: " + error.what() +
                     what_to_do_at_start(error));
} catch (const std::filesystem::filesystem_error& error) {
  throw JournalError("the journal " + file.string() + " is damaged and cannot be mended: " + error.what() +
                     "; make room there or mend the disk, or choose another folder with --state");
}

void Journal::mend() {
  const std::filesystem::path file = state_->file;
  state_.reset();
  mended_ = salvage(file);
  state_ = std::make_unique<State>(file);
  state_->begin();
}

Journal::~Journal() {
  try {
    state_->database.sqlite().setBusyTimeout(journal_patience_ms);
    state_->set_fact("is_running", 0);
    state_->sync.wake({state_->writes, state_->database.log_size()});
  } catch (const SQLite::Exception&) {
    // The next start takes this for a crash, which is right.
  }
}

void Journal::State::begin() {
  SQLite::Transaction transaction(database.sqlite(), SQLite::TransactionBehavior::IMMEDIATE);
  database.run(
      "UPDATE jobs SET crashes = CASE WHEN is_live AND (SELECT value FROM facts WHERE name = 'is_running') "
      "THEN crashes + 1 ELSE 0 END WHERE crashes != 0 OR is_live");
  set_fact("is_running", 1);
  set_fact("lives", lives = fact("lives") + 1);
  writes = fact("writes");
  lost_writes = std::max(std::int64_t{0}, marked_writes(file) - writes);
  if (lost_writes > 0) set_fact("writes", writes = marked_writes(file));  // told once
  const Query last = database.query("SELECT max(id) FROM pixels");
  if (last->executeStep()) last_tile = last->getColumn(0);
  transaction.commit();
  database.sqlite().setBusyTimeout(writer_patience_ms);
}

std::int64_t Journal::State::fact(const char* name) {
  const Query query = database.query("SELECT value FROM facts WHERE name = ?", std::string(name));
  return query->executeStep() ? query->getColumn(0).getInt64() : 0;
}

void Journal::State::set_fact(const char* name, std::int64_t value) {
  database.run("UPDATE facts SET value = ? WHERE name = ?", value, std::string(name));
}

bool Journal::write(std::span<const FarmRecord> records) try {
  if (const auto fault = state_->sync.take_fault())
    throw JournalError("the journal cannot be synced: " + *fault + what_to_do);
  for (const FarmRecord& record : records)
    if (const auto* lost = std::get_if<PassesLost>(&record.fact)) state_->forget(*lost);
  const auto workers = state_->workers;
  const std::int64_t last_tile = state_->tile_before = state_->last_tile;
  try {
    state_->in_one([&] {
      for (const FarmRecord& record : records)
        std::visit([this](const auto& fact) { state_->write(fact); }, record.fact);
    });
  } catch (...) {
    state_->workers = workers, state_->last_tile = last_tile;
    throw;
  }
  // Faster than new ones come, also when there is never nothing else to do.
  state_->try_to_delete(2 * (state_->last_tile - last_tile));
  return true;
} catch (const SQLite::Exception& error) {
  if (is_busy(error)) return false;
  state_->refuse_to_write(error);
}

std::optional<std::string> Journal::until_synced() { return state_->sync.until_synced(); }

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
  state_->note_damage();
  state_->is_tidy = true;  // what is left will be deleted when it is mended
}

void Journal::State::in_one(const std::function<void()>& changes) {
  SQLite::Transaction transaction(database.sqlite(), SQLite::TransactionBehavior::IMMEDIATE);
  changes();
  set_fact("writes", writes + 1);
  transaction.commit();
  ++writes;
  sync.wake({writes, database.log_size()});
}

void Journal::State::refuse_to_write(const SQLite::Exception& error) const {
  if (is_damage(error)) note_damage();
  throw JournalError("the journal " + file.string() + " cannot be written: " + error.what() +
                     (is_damage(error) ? what_if_damaged : what_to_do));
}

void Journal::State::note_damage() const { std::ofstream{note_of_damage(file)}; }

void Journal::State::write(const JobAdded& added) {
  films[added.id] = {added.spec.settings.width, added.spec.settings.height};
  const Bytes row = seal(encode_row(added), key_of(added.id));
  database.run("INSERT INTO jobs (id, spec) VALUES (?, ?)", number_of(added.id), row);
}

void Journal::State::write(const FrameAdded& added) {
  FrameRow frame{added.scene_hash, {}};
  for (const AssetData& asset : added.assets) frame.assets.push_back(asset.hash);
  const Bytes row = seal(encode_row(frame), key_of(added.id));
  database.run("INSERT INTO frames (job, frame, body, has_scene) VALUES (?, ?, ?, ?)",
               number_of(added.id.job), added.id.frame, row, added.scene ? 1 : 0);
  if (!added.scene) return;
  keep_blob(added.id, added.scene_hash, added.scene);
  for (const AssetData& asset : added.assets) keep_blob(added.id, asset.hash, asset.bytes);
}

void Journal::State::keep_blob(FrameId user, const std::string& hash, const SharedBytes& bytes) {
  database.run("INSERT OR IGNORE INTO uses VALUES (?, ?, ?)", number_of(user.job), user.frame, hash);
  const Query known = database.query("SELECT 1 FROM blobs WHERE hash = ?", hash);
  const bool is_known = known->executeStep();
  if (is_known) return;
  const Bytes row = seal(*bytes, {});
  database.run("INSERT INTO blobs VALUES (?, ?)", hash, row);
}

void Journal::State::write(const FrameStarted& started) {
  database.run("UPDATE frames SET started = ? WHERE job = ? AND frame = ?", started.at.count(),
               number_of(started.id.job), started.id.frame);
}

void Journal::State::write(const TileCommitted& commit) {
  const std::int64_t id = ++last_tile;
  const auto number = [&](const std::string& name) {
    const auto worker = workers.find(name);
    return worker == workers.end() ? 0 : static_cast<std::uint64_t>(worker->second);
  };
  std::vector<std::uint64_t> helpers;
  for (const std::string& name : commit.helpers) helpers.push_back(number(name));
  const Bytes pixels = seal(pack_pixels(commit), key_of_pixels(id));
  database.run("INSERT INTO pixels VALUES (?, ?)", id, pixels);
  const Bytes row = seal(encode_row(commit, number(commit.worker), helpers), key_of(commit.frame, id));
  database.run("INSERT INTO tiles VALUES (?, ?, ?, ?)", number_of(commit.frame.job), commit.frame.frame, id,
               row);
}

void Journal::State::write(const PassesLost& lost) {
  std::vector<std::int64_t> ids;
  find_lost(lost, tile_before, ids);
  for (const std::int64_t id : ids) delete_tile(lost.frame, id);
}

void Journal::State::forget(const PassesLost& lost) {
  is_tidy = false;
  std::vector<std::int64_t> ids;
  as_far_as_sound([&] { find_lost(lost, 0, ids); });
  for (const std::int64_t id : ids) as_far_as_sound([&] { delete_tile(lost.frame, id); });
}

void Journal::State::find_lost(const PassesLost& lost, std::int64_t after, std::vector<std::int64_t>& ids) {
  const Query query = database.query("SELECT id, body FROM tiles WHERE job = ? AND frame = ? AND id > ?",
                                     number_of(lost.frame.job), lost.frame.frame, after);
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

void Journal::State::as_far_as_sound(const std::function<void()>& changes) const try {
  changes();
} catch (const SQLite::Exception& error) {
  if (!is_damage(error)) throw;
  note_damage();
}

void Journal::State::write(const JobChanged& changed) {
  const Bytes row = seal(encode_row(changed), key_of(changed.id));
  const bool is_live = changed.state == JobState::running;
  // Who was not being rendered in between begins anew.
  database.run("UPDATE jobs SET status = ?, is_live = ?, crashes = crashes * ? WHERE id = ?", row, is_live,
               is_live, number_of(changed.id));
}

void Journal::State::write(const SceneDropped& dropped) { drop_scene(dropped.id); }

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

bool Journal::State::has_waste() { return database.query("SELECT 1 FROM waste")->executeStep(); }

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

void Journal::State::write(const WorkerNamed& named) {
  database.run("INSERT OR IGNORE INTO workers (name) VALUES (?)", named.name);
  const Query query = database.query("SELECT id FROM workers WHERE name = ?", named.name);
  if (query->executeStep()) workers[named.name] = query->getColumn(0);
}

void Journal::State::write(const WorkerDrained& drained) {
  database.run("UPDATE workers SET is_drained = ? WHERE name = ?", drained.is_drained, drained.name);
}

void Journal::State::write(const WorkerBanned& banned) {
  database.run("UPDATE workers SET is_banned = ? WHERE name = ?", banned.is_banned, banned.name);
}

void Journal::State::write(const WorkerKnown& known) {
  database.run("INSERT OR REPLACE INTO identities (identity, name) VALUES (?, ?)", known.identity,
               known.name);
  database.run("UPDATE identities SET is_banned = ?, good_in_a_row = ?, mismatches = ? WHERE identity = ?",
               known.is_banned, known.trust.good_in_a_row, known.trust.mismatches, known.identity);
}

}  // namespace rayfarm
