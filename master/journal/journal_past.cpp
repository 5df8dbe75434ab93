// Reading.

#include <algorithm>

#include "master/journal/journal_state.h"
#include "master/journal/salvage.h"

namespace rayfarm {
namespace {

void add(Journal::Opened& opened, auto fact) { opened.past.records.push_back({std::move(fact)}); }

std::string name_of_job(JobId id) { return "job " + std::to_string(number_of(id)); }

}  // namespace

Journal::Opened Journal::read() try {
  Opened opened;
  try {
    opened = state_->read();
  } catch (const SQLite::Exception& error) {
    if (!is_damage(error) || was_mended_) throw;
    mend();
    opened = state_->read();
  }
  if (was_mended_)
    opened.warnings.insert(opened.warnings.begin(),
                           "the journal " + file_.string() +
                               " was damaged on the disk: what can be read of it was written anew, the "
                               "damaged one is beside it (.damaged)");
  return opened;
} catch (const SQLite::Exception& error) {
  throw JournalError("the journal " + file_.string() + " cannot be read: " + error.what() +
                     what_to_do_at_start(error));
}

Journal::Opened Journal::State::read() {
  Opened opened;
  opened.past.life = static_cast<std::uint32_t>(lives);
  opened.is_cut = lost_writes > 0;
  if (opened.is_cut)
    opened.warnings.push_back("the end of the journal " + file.string() +
                              " was damaged on the disk: the last " + std::to_string(lost_writes) +
                              " writes are lost; jobs that are missing must be submitted again");
  read_workers(opened);
  const Query last = database.query("SELECT seq FROM sqlite_sequence WHERE name = 'jobs'");
  if (last->executeStep()) add(opened, JobDropped{static_cast<JobId>(last->getColumn(0).getInt64())});

  std::vector<JobId> jobs;
  const Query query = database.query("SELECT id, crashes FROM jobs ORDER BY id");
  while (query->executeStep()) {
    jobs.push_back(static_cast<JobId>(query->getColumn(0).getInt64()));
    if (query->getColumn(1).getInt() >= 2) opened.suspects.push_back(jobs.back());
  }
  for (const JobId job : jobs) read_job(opened, job);
  blobs.clear();
  opened.past.read_pixels = [this](FrameId id, const auto& put) { read_pixels(id, put); };
  return opened;
}

void Journal::State::read_workers(Opened& opened) {
  const Query query = database.query("SELECT id, name, is_drained, is_banned FROM workers ORDER BY id");
  while (query->executeStep()) {
    const std::string name = query->getColumn(1);
    workers[name] = query->getColumn(0);
    worker_names[query->getColumn(0)] = name;
    add(opened, WorkerNamed{name});
    if (query->getColumn(2).getInt()) add(opened, WorkerDrained{name, true});
    if (query->getColumn(3).getInt()) add(opened, WorkerBanned{name, true});
  }
  const Query known = database.query(
      "SELECT identity, name, is_banned, good_in_a_row, mismatches FROM identities ORDER BY rowid");
  while (known->executeStep())
    add(opened, WorkerKnown{known->getColumn(0),
                            known->getColumn(1),
                            known->getColumn(2).getInt() != 0,
                            {known->getColumn(3).getUInt(), known->getColumn(4).getUInt()}});
}

void Journal::State::read_job(Opened& opened, JobId id) {
  const Query query = database.query("SELECT spec, status FROM jobs WHERE id = ?", number_of(id));
  if (!query->executeStep()) return;
  const auto spec = unseal(bytes_of(query->getColumn(0)), key_of(id));
  if (!spec) {
    opened.warnings.push_back(name_of_job(id) +
                              " is lost: what was asked for was damaged on the disk; submit it again");
    return;
  }
  JobAdded job = decode_job(id, *spec);
  films[id] = {job.spec.settings.width, job.spec.settings.height};
  const FrameRange frames = job.spec.frames.value();
  JobChanged status{
      id, JobState::paused, job.spec.priority, "its state was damaged on the disk", job.spec.key, 0, {}};
  if (const auto sealed = unseal(bytes_of(query->getColumn(1)), key_of(id)))
    status = decode_change(id, *sealed);
  opened.latest = std::max({opened.latest, job.submitted, status.ended.value_or(FarmTime{})});
  add(opened, std::move(job));
  const Query last = database.query("SELECT max(frame) FROM frames WHERE job = ?", number_of(id));
  const std::int64_t known =
      last->executeStep() && !last->isColumnNull(0) ? last->getColumn(0).getInt64() : -1;
  for (std::uint32_t place = 0; place < frames.count() && frames.at(place) <= known; ++place)
    read_frame(opened, {id, frames.at(place)});
  add(opened, std::move(status));
}

void Journal::State::read_frame(Opened& opened, FrameId id) {
  const Query query =
      database.query("SELECT body, has_scene, started, dropped FROM frames WHERE job = ? AND frame = ?",
                     number_of(id.job), id.frame);
  FrameAdded frame{id, "", nullptr, {}};
  if (!query->executeStep()) return add(opened, std::move(frame));  // lost, but later ones are there
  const auto body = unseal(bytes_of(query->getColumn(0)), key_of(id));
  const FrameRow row = body ? decode_frame(*body) : FrameRow{};
  frame.scene_hash = row.scene_hash;
  const bool has_scene = query->getColumn(1).getInt() != 0;
  const bool is_started = !query->getColumn(2).isNull();
  const FarmTime started{query->getColumn(2).getInt64()};
  const bool is_dropped = !query->getColumn(3).isNull();
  std::optional<PictureDropped> dropped;
  if (const auto sealed = unseal(bytes_of(query->getColumn(3)), key_of(id)))
    dropped = decode_dropped(id, *sealed);

  if (has_scene && body) {
    frame.scene = read_blob(opened, row.scene_hash);
    for (const std::string& hash : row.assets) {
      const SharedBytes bytes = read_blob(opened, hash);
      if (!bytes) frame.scene = nullptr;  // it cannot be rendered without
      frame.assets.push_back({hash, bytes});
    }
    if (!frame.scene) frame.assets.clear();
  }
  add(opened, std::move(frame));
  if (!is_started) return;
  opened.latest = std::max(opened.latest, started);
  add(opened, FrameStarted{id, started});
  if (!is_dropped) read_tiles(opened, id);
  if (dropped) add(opened, *dropped);
}

void Journal::State::read_tiles(Opened& opened, FrameId id) {
  const Query query = database.query("SELECT id, body FROM tiles WHERE job = ? AND frame = ? ORDER BY id",
                                     number_of(id.job), id.frame);
  std::size_t damaged = 0;
  while (query->executeStep()) {
    const auto body = unseal(bytes_of(query->getColumn(1)), key_of(id, query->getColumn(0).getInt64()));
    if (!body) {
      ++damaged;
      continue;
    }
    TileRow row = decode_tile(id, *body);
    const auto name = [&](std::uint64_t number) {
      const auto worker = worker_names.find(static_cast<std::int64_t>(number));
      return worker == worker_names.end() ? "(one of many)" : worker->second;
    };
    row.commit.worker = name(row.worker);
    for (const std::uint64_t helper : row.helpers) row.commit.helpers.push_back(name(helper));
    opened.latest = std::max(opened.latest, row.commit.at);
    add(opened, std::move(row.commit));
  }
  if (damaged > 0)
    opened.warnings.push_back("of " + name_of_job(id.job) + " the records of " + std::to_string(damaged) +
                              " tiles were damaged on the disk");
}

SharedBytes Journal::State::read_blob(Opened& opened, const std::string& hash) {
  if (const auto known = blobs.find(hash); known != blobs.end()) return known->second;
  SharedBytes& blob = blobs[hash];
  const Query query = database.query("SELECT data FROM blobs WHERE hash = ?", hash);
  try {
    if (query->executeStep())
      if (const auto bytes = unseal(bytes_of(query->getColumn(0)), {}))
        blob = std::make_shared<const Bytes>(bytes->begin(), bytes->end());
  } catch (const SQLite::Exception&) {
    // As damaged.
  }
  if (!blob) opened.warnings.push_back("the scene or asset " + hash + " was damaged on the disk");
  return blob;
}

void Journal::State::read_pixels(FrameId id, const std::function<void(const TileCommitted&)>& put) try {
  const Query query = database.query("SELECT id, body FROM tiles WHERE job = ? AND frame = ? ORDER BY id",
                                     number_of(id.job), id.frame);
  while (query->executeStep()) {
    const std::int64_t number = query->getColumn(0);
    const auto body = unseal(bytes_of(query->getColumn(1)), key_of(id, number));
    if (!body) continue;
    TileCommitted commit = decode_tile(id, *body).commit;
    const Query pixels = database.query("SELECT data FROM pixels WHERE id = ?", number);
    try {
      if (!pixels->executeStep()) continue;
      const auto packed = unseal(bytes_of(pixels->getColumn(0)), key_of_pixels(number));
      if (!packed) continue;
      unpack_pixels(*packed, films.at(id.job), commit);
    } catch (const CodecError&) {
      continue;
    } catch (const SQLite::Exception& error) {
      if (!is_damage(error)) throw;
      note_damage(file);
      continue;  // pages of these pixels are damaged
    }
    put(commit);
  }
} catch (const SQLite::Exception& error) {
  if (!is_damage(error)) throw;
  note_damage(file);  // what cannot be read is missing
}

}  // namespace rayfarm
