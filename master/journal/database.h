// The journal's SQLite file: how it is opened, what is in it, and statements that are prepared once.
#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "common/net/codec.h"

namespace rayfarm {

constexpr int journal_patience_ms = 5000;  // with its other connection: one writes, the other syncs
constexpr int writer_patience_ms = 5;      // of a farm that is at work

/// The file is no whole journal: no time and no room will help.
bool is_damage(const SQLite::Exception& error);
/// The end of a sentence, when a journal cannot be opened.
const char* what_to_do_at_start(const SQLite::Exception& error);
/// The other connection is at it.
bool is_busy(const SQLite::Exception& error);

/// A statement under way; while it is, others do not see the end of the log.
struct EndQuery {
  void operator()(SQLite::Statement* statement) const { statement->tryReset(); }
};
using Query = std::unique_ptr<SQLite::Statement, EndQuery>;

/// Opened, made if it is missing, its schema made whole. Throws JournalError.
class Database {
 public:
  explicit Database(const std::filesystem::path& file);
  Database(const Database&) = delete;

  /// The statement with these values in place of its question marks, to be stepped through. The text is a literal.
  template <class... Values>
  Query query(const char* sql, const Values&... values) {
    SQLite::Statement& statement = prepared(sql);
    int place = 0;
    (bind(statement, ++place, values), ...);
    return Query(&statement);
  }
  template <class... Values>
  void run(const char* sql, const Values&... values) {
    query(sql, values...)->exec();
  }

  SQLite::Database& sqlite() { return sqlite_; }
  /// What the write-ahead log held, in bytes, after the last write of this connection. Its file may be larger: it is
  /// written again from its begin once all of it was moved.
  std::int64_t log_size() const { return log_pages_ * page_size_; }

 private:
  SQLite::Statement& prepared(const char* sql);
  static void bind(SQLite::Statement& statement, int place, std::int64_t value) {
    statement.bind(place, value);
  }
  static void bind(SQLite::Statement& statement, int place, const std::string& value) {
    statement.bind(place, value);
  }
  static void bind(SQLite::Statement& statement, int place, ByteView value) {
    statement.bindNoCopy(place, value.data(), static_cast<int>(value.size()));
  }

  SQLite::Database sqlite_;
  std::int64_t log_pages_ = 0, page_size_ = 0;
  std::map<const char*, SQLite::Statement> statements_;
};

/// A column's bytes, as long as the statement stays on its row.
inline ByteView bytes_of(const SQLite::Column& column) {
  return {static_cast<const std::uint8_t*>(column.getBlob()), static_cast<std::size_t>(column.getBytes())};
}

}  // namespace rayfarm
