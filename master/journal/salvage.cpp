#include "master/journal/salvage.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "master/journal/database.h"
#include "master/journal/wal_sync.h"

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

/// Up to what is damaged.
template <class Body>
void as_far_as_sound(Body body) try {
  body();
} catch (const SQLite::Exception& error) {
  if (!is_damage(error)) throw;
}

void put_row(SQLite::Database& to, const std::string& table, SQLite::Statement& row) {
  std::string names, marks;
  for (int i = 0; i < row.getColumnCount(); ++i) {
    names += (i ? "," : "") + std::string(row.getColumnName(i));
    marks += i ? ",?" : "?";
  }
  SQLite::Statement put(to, "INSERT OR REPLACE INTO " + table + " (" + names + ") VALUES (" + marks + ")");
  for (int i = 0; i < row.getColumnCount(); ++i) {
    const SQLite::Column column = row.getColumn(i);
    if (column.isInteger())
      put.bind(i + 1, column.getInt64());
    else if (column.isText())
      put.bind(i + 1, column.getString());
    else if (column.isBlob())
      put.bind(i + 1, column.getBlob(), column.getBytes());
  }
  try {
    put.exec();
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() != SQLITE_CONSTRAINT) throw;  // a value that cannot have been there: damage, too
  }
}

/// From both ends to the first page that is damaged. `where` chooses among the rows, `key` is their order.
void copy_rows(SQLite::Database& from, SQLite::Database& to, const std::string& table,
               const std::vector<std::string>& key, const std::string& where = "1") {
  bool is_whole = false;
  for (const char* direction : {" ASC", " DESC"}) {
    if (is_whole) return;
    std::string order;
    for (const std::string& column : key) order += (order.empty() ? "" : ",") + column + direction;
    as_far_as_sound([&] {
      SQLite::Statement row(from, "SELECT * FROM " + table + " WHERE " + where + " ORDER BY " + order);
      while (row.executeStep()) put_row(to, table, row);
      is_whole = true;
    });
  }
}

void copy_journal(SQLite::Database& from, SQLite::Database& to) {
  copy_rows(from, to, "facts", {"name"});
  copy_rows(from, to, "workers", {"id"});
  copy_rows(from, to, "identities", {"rowid"});
  copy_rows(from, to, "jobs", {"id"});
  copy_rows(from, to, "frames", {"job", "frame"});
  copy_rows(from, to, "blobs", {"rowid"});
  copy_rows(from, to, "uses", {"job", "frame", "hash"});
  copy_rows(from, to, "waste", {"job", "frame"});

  SQLite::Statement frame(to, "SELECT job, frame FROM frames UNION SELECT job, frame FROM waste");
  while (frame.executeStep())
    copy_rows(from, to, "tiles", {"job", "frame", "id"},
              "job = " + frame.getColumn(0).getString() + " AND frame = " + frame.getColumn(1).getString());
  SQLite::Statement tile(to, "SELECT id FROM tiles");
  while (tile.executeStep()) copy_rows(from, to, "pixels", {"id"}, "id = " + tile.getColumn(0).getString());
  // Their numbers may be given again.
  to.exec("DELETE FROM tiles WHERE id NOT IN (SELECT id FROM pixels)");
  // What belongs to no job any more is deleted by and by.
  to.exec("INSERT OR IGNORE INTO waste SELECT job, frame FROM frames WHERE job NOT IN (SELECT id FROM jobs)");
  to.exec("DELETE FROM frames WHERE job NOT IN (SELECT id FROM jobs)");
  to.exec("DELETE FROM uses WHERE job NOT IN (SELECT id FROM jobs)");

  std::int64_t last = to.execAndGet(
      "SELECT max((SELECT ifnull(max(id), 0) FROM jobs), (SELECT ifnull(max(job), 0) FROM waste))");
  as_far_as_sound([&] {
    SQLite::Statement known(from, "SELECT seq FROM sqlite_sequence WHERE name = 'jobs'");
    if (known.executeStep()) last = std::max(last, known.getColumn(0).getInt64());
  });
  to.exec("DELETE FROM sqlite_sequence WHERE name = 'jobs'");
  to.exec("INSERT INTO sqlite_sequence VALUES ('jobs', " + std::to_string(last) + ")");
}

/// Not written yet, or all of it.
void copy_to(const fs::path& made, const fs::path& journal) {
  Database fresh(made);
  fresh.sqlite().exec(
      "PRAGMA journal_mode = DELETE");  // no second file that would have to be moved into this one
  SQLite::Database old(journal.string(), SQLite::OPEN_READWRITE, journal_patience_ms);
  old.execAndGet("SELECT count(*) FROM sqlite_master");  // or nothing can be read
  SQLite::Transaction transaction(fresh.sqlite());
  copy_journal(old, fresh.sqlite());
  fresh.run("UPDATE facts SET value = 0 WHERE name = 'is_running'");  // it is no job's fault
  // Where the numbers are lost with their page: no lease has a number of before, and no writes are missing.
  fresh.sqlite().exec("UPDATE facts SET value = unixepoch() WHERE name = 'lives' AND value = 0");
  fresh.run("UPDATE facts SET value = ? WHERE name = 'writes' AND value = 0", marked_writes(journal));
  transaction.commit();
}

void remove_all_of(const fs::path& journal) {
  for (const char* part : {"", "-wal", "-shm", "-journal"}) fs::remove(journal.string() + part);
}

/// By a second name, which costs no room, where the file system knows such.
void keep(const fs::path& file, const fs::path& as) {
  if (!fs::exists(file)) return;
  std::error_code no_links;
  fs::create_hard_link(file, as, no_links);
  if (no_links) fs::copy_file(file, as);
}

void keep_damaged(const fs::path& journal) {
  const std::string name = journal.string() + ".damaged";
  std::string kept = name;
  for (int i = 2; fs::exists(kept); ++i) kept = name + std::to_string(i);
  keep(journal.string() + "-wal", kept + "-wal");
  keep(journal, kept);
}

fs::path mended(const fs::path& journal) { return journal.string() + "-mended"; }
/// While there is this file, the one above is whole.
fs::path note_of_mended(const fs::path& journal) { return journal.string() + "-mended-is-whole"; }
fs::path note_of_damage(const fs::path& journal) { return journal.string() + "-is-damaged"; }

void put_note(const fs::path& file) {
  const int made = open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  if (made < 0) return;  // a disk that takes no note: the damage will be met again
  fsync(made);
  close(made);
}

}  // namespace

void note_damage(const fs::path& journal) { put_note(note_of_damage(journal)); }

bool wants_mending(const fs::path& journal) {
  return fs::exists(note_of_mended(journal)) || (fs::exists(journal) && fs::exists(note_of_damage(journal)));
}

void salvage(const fs::path& journal) {
  const fs::path made = mended(journal), is_whole = note_of_mended(journal);
  if (!fs::exists(is_whole)) {
    remove_all_of(made);
    copy_to(made, journal);
    keep_damaged(journal);
    sync_to_disk(made);
    put_note(is_whole);
    if (!fs::exists(is_whole)) throw std::runtime_error(is_whole.string() + " cannot be written");
  }
  if (fs::exists(made)) {
    for (const char* part : {"-wal", "-shm"}) fs::remove(journal.string() + part);  // of the old one
    fs::rename(made, journal);
  }
  fs::remove(note_of_damage(journal));
  fs::remove(is_whole);
}

}  // namespace rayfarm
