// What a journal is made of. Only journal's own files include this.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "master/journal/database.h"
#include "master/journal/journal.h"
#include "master/journal/rows.h"
#include "master/journal/wal_sync.h"

namespace rayfarm {

inline std::int64_t number_of(JobId id) { return static_cast<std::int64_t>(id); }
inline RowKey key_of(JobId id) { return {static_cast<std::uint64_t>(id), 0, 0}; }
inline RowKey key_of(FrameId id, std::int64_t number = 0) {
  return {static_cast<std::uint64_t>(id.job), id.frame, static_cast<std::uint64_t>(number)};
}
inline RowKey key_of_pixels(std::int64_t id) { return {0, 0, static_cast<std::uint64_t>(id)}; }

struct Journal::State {
  explicit State(const std::filesystem::path& path) : file(path), database(path), sync(path) {}

  std::filesystem::path file;
  Database database;
  std::map<std::string, std::int64_t> workers;       // ids by name; 0: none of them
  std::map<std::int64_t, std::string> worker_names;  // the reverse
  std::map<JobId, Size> films;                       // of the jobs that were read
  std::int64_t last_tile = 0, tile_before = 0;       // the latter of the writes before this one
  std::int64_t writes = 0;                           // transactions
  std::int64_t lives = 0;                            // this one too
  std::int64_t lost_writes = 0;                      // that were synced once, and are gone
  bool is_tidy = false;                              // nothing was left to do, and nothing was dropped since
  WalSync sync;

  /// A crash is counted against those that were live.
  void begin();
  std::int64_t fact(const char* name);
  void set_fact(const char* name, std::int64_t value);

  // Writing.
  /// All of the changes or, when it throws, none.
  void in_one(const std::function<void()>& changes);
  [[noreturn]] void refuse_to_write(const SQLite::Exception& error) const;
  /// Not within in_one(): SQLite refuses all of a transaction that met damage.
  /// False: what is damaged was met, and noted.
  bool as_far_as_sound(const std::function<void()>& changes) const;
  /// Of the tiles that are lost, those of earlier writes. What stays as its page is damaged is lost at the next start.
  void forget(const PassesLost& lost);
  void find_lost(const char* sql, const PassesLost& lost, std::int64_t after, std::vector<std::int64_t>& ids);
  void delete_tile(FrameId frame, std::int64_t id);
  void write(const JobAdded& added);
  void write(const FrameAdded& added);
  void write(const FrameStarted& started);
  void write(const TileCommitted& commit);
  void write(const PassesLost& lost);
  void write(const JobChanged& changed);
  void write(const SceneDropped& dropped);
  void write(const PictureDropped& dropped);
  void write(const JobDropped& dropped);
  void write(const WorkerNamed& named);
  void write(const WorkerDrained& drained);
  void write(const WorkerBanned& banned);
  void write(const WorkerKnown& known);
  void keep_blob(FrameId user, const std::string& hash, const SharedBytes& bytes);
  bool has_waste();
  bool has_spare_room();
  /// Some of the file's end, when much of it is free. False: it is not.
  bool give_back_room();
  void drop_scene(FrameId id);
  void drop_tiles(FrameId id);
  /// At most so many of those that were dropped, and pictures. False: there are none.
  bool delete_waste(std::int64_t tiles);
  void try_to_delete(std::int64_t tiles);

  // Reading.
  Opened read();
  void read_workers(Opened& opened);
  void read_job(Opened& opened, JobId id);
  void read_frame(Opened& opened, FrameId id);
  void read_tiles(Opened& opened, FrameId id);
  SharedBytes read_blob(Opened& opened, const std::string& hash);
  void read_pixels(FrameId id, const std::function<void(const TileCommitted&)>& put);
  std::map<std::string, SharedBytes> blobs;  // while all is read
};

}  // namespace rayfarm
