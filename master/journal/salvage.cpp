#include "master/journal/salvage.h"

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
  put.exec();
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

  std::int64_t last = to.execAndGet("SELECT max(0, ifnull(max(job), 0)) FROM frames");
  as_far_as_sound([&] {
    SQLite::Statement known(from, "SELECT seq FROM sqlite_sequence WHERE name = 'jobs'");
    if (known.executeStep()) last = std::max(last, known.getColumn(0).getInt64());
  });
  to.exec("DELETE FROM sqlite_sequence WHERE name = 'jobs'");
  to.exec("INSERT INTO sqlite_sequence VALUES ('jobs', " + std::to_string(last) + ")");
}

void remove_all_of(const fs::path& journal) {
  for (const char* part : {"", "-wal", "-shm"}) fs::remove(journal.string() + part);
}

}  // namespace

fs::path note_of_damage(const fs::path& journal) { return journal.string() + "-is-damaged"; }

fs::path salvage(const fs::path& journal) {
  const fs::path made = journal.string() + "-mended", kept = journal.string() + ".damaged";
  remove_all_of(made);
  {
    Database fresh(made);
    SQLite::Database old(journal.string(), SQLite::OPEN_READWRITE, journal_patience_ms);
    SQLite::Transaction transaction(fresh.sqlite());
    copy_journal(old, fresh.sqlite());
    fresh.run("UPDATE facts SET value = 0 WHERE name = 'is_running'");  // it is no job's fault
    // A number of writes that is lost with its page is no loss of writes.
    fresh.run("UPDATE facts SET value = ? WHERE name = 'writes' AND value = 0", marked_writes(journal));
    transaction.commit();
  }  // both logs are in their files then, and gone
  remove_all_of(kept);
  if (fs::exists(journal.string() + "-wal")) fs::rename(journal.string() + "-wal", kept.string() + "-wal");
  std::error_code not_here;
  fs::create_hard_link(journal, kept, not_here);
  if (not_here) fs::copy_file(journal, kept);
  sync_to_disk(made);
  fs::rename(made, journal);
  fs::remove(note_of_damage(journal));
  return kept;
}

}  // namespace rayfarm
