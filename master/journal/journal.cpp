// Writing.
#include "master/journal/journal.h"

#include <algorithm>

#include "master/journal/journal_state.h"
#include "master/journal/salvage.h"

namespace rayfarm {
namespace {

constexpr auto what_to_do = "; make room there or mend the disk, then resume the job";
constexpr auto what_if_damaged = "; start the master again: what can be read is then written anew";

}  // namespace

Journal::Journal(const std::filesystem::path& file) try : file_(file) {
  if (wants_mending(file)) mend_file();
  state_ = std::make_unique<State>(file);
  try {
    state_->begin();
  } catch (const SQLite::Exception& error) {
    if (!is_damage(error) || was_mended_) throw;
    mend();
  }
} catch (const SQLite::Exception& error) {
  throw JournalError("the journal " + file.string() + " cannot be used: " + error.what() +
                     what_to_do_at_start(error));
}

void Journal::mend_file() try {
  salvage(file_);
  was_mended_ = true;
} catch (const SQLite::Exception&) {
  throw;
} catch (const std::runtime_error& error) {  // of the file system
  throw JournalError("the journal " + file_.string() + " is damaged, and cannot be mended: " + error.what() +
                     "; make room there or mend the disk, or choose another folder with --state");
}

void Journal::mend() {
  state_.reset();
  mend_file();
  state_ = std::make_unique<State>(file_);
  state_->begin();
}

Journal::~Journal() {
  if (!state_) return;  // it could not be mended
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

void Journal::State::in_one(const std::function<void()>& changes) {
  SQLite::Transaction transaction(database.sqlite(), SQLite::TransactionBehavior::IMMEDIATE);
  changes();
  set_fact("writes", writes + 1);
  transaction.commit();
  ++writes;
  sync.wake({writes, database.log_size()});
}

void Journal::State::refuse_to_write(const SQLite::Exception& error) const {
  if (is_damage(error)) note_damage(file);
  throw JournalError("the journal " + file.string() + " cannot be written: " + error.what() +
                     (is_damage(error) ? what_if_damaged : what_to_do));
}

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

void Journal::State::write(const JobChanged& changed) {
  const Bytes row = seal(encode_row(changed), key_of(changed.id));
  const bool is_live = changed.state == JobState::running;
  // Who was not being rendered in between begins anew.
  database.run("UPDATE jobs SET status = ?, is_live = ?, crashes = crashes * ? WHERE id = ?", row, is_live,
               is_live, number_of(changed.id));
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
