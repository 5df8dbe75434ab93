#include "master/journal/database.h"

#include <sqlite3.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "master/journal/journal.h"

namespace rayfarm {
namespace {

constexpr int schema_version = 4;

// jobs      spec and status: rows.h, sealed by the job; is_live: it is being rendered; crashes: in a row
// frames    what came of a frame (sealed), when it started; dropped: what is known of a picture that is gone (sealed)
// blobs     scenes and assets by hash, sealed; uses: which frames they belong to
// tiles     one row a commit (sealed by job, frame, id), small, as all are read at a start
// pixels    those of the commit with the same id, sealed by it
// workers   names of all that were here, in the order of their coming
// identities who they are, whatever their names: a row for each name, the last is the latest; the rest is the same in all
// waste     dropped pictures whose tiles and pixels are still to be deleted
// facts     is_running; lives: how often it was opened; writes: how many transactions there were
constexpr auto schema = R"(
CREATE TABLE facts (name TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE jobs (id INTEGER PRIMARY KEY AUTOINCREMENT, spec BLOB NOT NULL, status BLOB,
                   is_live INTEGER NOT NULL DEFAULT 0, crashes INTEGER NOT NULL DEFAULT 0);
CREATE TABLE frames (job INTEGER, frame INTEGER, body BLOB NOT NULL, has_scene INTEGER NOT NULL, started INTEGER,
                     dropped BLOB, PRIMARY KEY (job, frame)) WITHOUT ROWID;
CREATE TABLE blobs (hash TEXT PRIMARY KEY, data BLOB NOT NULL);
CREATE TABLE uses (job INTEGER, frame INTEGER, hash TEXT, PRIMARY KEY (job, frame, hash)) WITHOUT ROWID;
CREATE INDEX uses_by_hash ON uses (hash);
CREATE TABLE tiles (job INTEGER, frame INTEGER, id INTEGER, body BLOB NOT NULL,
                    PRIMARY KEY (job, frame, id)) WITHOUT ROWID;
CREATE TABLE pixels (id INTEGER PRIMARY KEY, data BLOB NOT NULL);
CREATE TABLE workers (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, is_drained INTEGER NOT NULL DEFAULT 0,
                      is_banned INTEGER NOT NULL DEFAULT 0);
INSERT INTO facts VALUES ('is_running', 0), ('lives', 0), ('writes', 0);
)";

constexpr auto identities = R"(
CREATE TABLE identities (identity TEXT NOT NULL, name TEXT NOT NULL, is_banned INTEGER NOT NULL DEFAULT 0,
                         good_in_a_row INTEGER NOT NULL DEFAULT 0, mismatches INTEGER NOT NULL DEFAULT 0,
                         PRIMARY KEY (identity, name));
)";

constexpr auto waste = R"(
CREATE TABLE waste (job INTEGER, frame INTEGER, PRIMARY KEY (job, frame)) WITHOUT ROWID;
)";

constexpr auto from_version_2 = R"(
INSERT INTO identities SELECT 'name ' || name, name, is_banned, good_in_a_row, mismatches FROM workers ORDER BY id;
ALTER TABLE workers DROP COLUMN good_in_a_row;
ALTER TABLE workers DROP COLUMN mismatches;
)";

/// Its own, so that SQLite gives the write-ahead log the same rights: jobs are nobody else's business.
std::string made(const std::filesystem::path& file) {
  const int made = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  if (made < 0)
    throw JournalError("the journal " + file.string() + " cannot be written: " + std::strerror(errno) +
                       "; choose another folder with --state");
  close(made);
  return file.string();
}

[[noreturn]] void refuse(const std::filesystem::path& file, const SQLite::Exception& error) {
  throw JournalError("the journal " + file.string() + " cannot be used: " + error.what() +
                     what_to_do_at_start(error));
}

void make_schema(SQLite::Database& database, const std::filesystem::path& file) {
  const int version = database.execAndGet("PRAGMA user_version");
  if (version > schema_version)
    throw JournalError("the journal " + file.string() + " was written by a newer rayfarm (its version " +
                       std::to_string(version) + ", known here " + std::to_string(schema_version) +
                       "): install that, or choose another folder with --state");
  if (version == schema_version) return;
  // Version and tables come in one transaction: there are all of them, or none.
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  if (version == 0) database.exec(schema);
  if (version < 3) database.exec(identities);
  database.exec(waste);
  if (version == 2) database.exec(from_version_2);
  database.exec("PRAGMA user_version = " + std::to_string(schema_version));
  transaction.commit();
}

int tell_pages(void* log_pages, sqlite3*, const char*, int pages) {
  *static_cast<std::int64_t*>(log_pages) = pages;
  return SQLITE_OK;
}

}  // namespace

bool is_damage(const SQLite::Exception& error) {
  return error.getErrorCode() == SQLITE_CORRUPT || error.getErrorCode() == SQLITE_NOTADB;
}

const char* what_to_do_at_start(const SQLite::Exception& error) {
  return is_damage(error)
             ? "; move it away to begin with an empty farm, or choose another folder with --state"
             : "; make room there or mend the disk, or choose another folder with --state";
}

bool is_busy(const SQLite::Exception& error) { return error.getErrorCode() == SQLITE_BUSY; }

Database::Database(const std::filesystem::path& file) try
    : sqlite_(made(file), SQLite::OPEN_READWRITE, journal_patience_ms) {
  sqlite_.exec("PRAGMA auto_vacuum = INCREMENTAL");  // counts for a new file only
  sqlite_.exec("PRAGMA journal_mode = WAL");
  sqlite_.exec("PRAGMA synchronous = NORMAL");    // WalSync syncs, on its thread
  sqlite_.exec("PRAGMA wal_autocheckpoint = 0");  // and moves the log into the file
  page_size_ = sqlite_.execAndGet("PRAGMA page_size");
  sqlite3_wal_hook(sqlite_.getHandle(), &tell_pages, &log_pages_);
  make_schema(sqlite_, file);
} catch (const SQLite::Exception& error) {
  refuse(file, error);
}

SQLite::Statement& Database::prepared(const char* sql) {
  auto known = statements_.find(sql);
  if (known == statements_.end()) known = statements_.try_emplace(sql, sqlite_, sql).first;
  known->second.tryReset();  // also after an error
  known->second.clearBindings();
  return known->second;
}

}  // namespace rayfarm
