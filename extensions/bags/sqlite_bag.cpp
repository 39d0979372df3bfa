#include "extensions/bags/sqlite_bag.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

// A bag of rosbag2 is plain tables. The file's own SQL (views, triggers, virtual tables, computed columns)
// never runs. A table has no more rows and no more bytes than its file, so that the work is bounded by the
// file's size even where its pages refer to one another without end (https://sqlite.org/security.html).
namespace joulepath {
namespace {

constexpr int kMostRowBytes = 256 << 20;
constexpr int kStepsPerCall = 1000;  ///< of the progress handler
/// Steps of SQLite's machine: a message takes about 30, and 35 bytes of the file.
constexpr std::int64_t kSteps = 1'000'000, kStepsPerByte = 8;

/// The order is found from times and row numbers alone: a sort never copies the messages. SQLite leaves out
/// the order of a subquery without LIMIT.
constexpr const char* kMessagesInOrder =
    "WITH in_order AS MATERIALIZED (SELECT rowid AS row FROM messages ORDER BY timestamp LIMIT -1) "
    "SELECT topic_id, timestamp, data FROM in_order CROSS JOIN messages ON messages.rowid = in_order.row";

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

/// Null if the tables are missing.
Statement prepared(const Database& database, const char* query) {
  sqlite3_stmt* raw = nullptr;
  sqlite3_prepare_v2(database.get(), query, -1, &raw, nullptr);
  return {raw, &sqlite3_finalize};
}

std::string_view bytes_of(const Statement& row, int column) {
  const void* bytes = sqlite3_column_blob(row.get(), column);
  return bytes ? std::string_view(static_cast<const char*>(bytes),
                                  static_cast<std::size_t>(sqlite3_column_bytes(row.get(), column)))
               : std::string_view();
}

/// Of the file and of its write-ahead log.
std::int64_t size_of(const std::string& file) {
  std::int64_t bytes = 0;
  for (const char* end : {"", "-wal"}) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file + end, error);
    if (!error) bytes += static_cast<std::int64_t>(size);
  }
  return bytes;
}

/// Calls remain until SQLite is interrupted.
int spend_call(void* calls_left) { return --*static_cast<std::int64_t*>(calls_left) < 0 ? 1 : 0; }

void restrain(const Database& database, std::int64_t& calls_left) {
  for (const auto& [setting, on] : {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                    {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                    {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                    {SQLITE_DBCONFIG_ENABLE_VIEW, 0}})
    sqlite3_db_config(database.get(), setting, on, nullptr);
  for (const auto& [limit, most] : {std::pair{SQLITE_LIMIT_LENGTH, kMostRowBytes},
                                    {SQLITE_LIMIT_SQL_LENGTH, 100'000},
                                    {SQLITE_LIMIT_EXPR_DEPTH, 100},
                                    {SQLITE_LIMIT_COMPOUND_SELECT, 4},
                                    {SQLITE_LIMIT_ATTACHED, 0}})
    sqlite3_limit(database.get(), limit, most);
  sqlite3_progress_handler(database.get(), kStepsPerCall, &spend_call, &calls_left);
}

/// The name of a file that does not change, as a URI.
std::string immutable_uri(const std::string& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string())
    uri += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  return uri + "?immutable=1";
}

/// Whether a rollback journal holds a transaction. A finished one may stay, with zeros as its header
/// (journal_mode PERSIST).
bool is_hot(const std::string& journal) {
  std::ifstream stream(journal, std::ios::binary);
  const char first = static_cast<char>(stream.get());
  return stream && first != 0;
}

/// A rollback journal holds what a recorder had not finished: the file alone may be half of a transaction.
void refuse_journal(const std::string& file, const NamedBy& named_by) {
  const std::string journal = file + "-journal";
  if (is_hot(journal))
    throw named_by.error(file, "an unfinished transaction in " + journal, "a bag that its recorder closed",
                         "sqlite3 " + file + " \"PRAGMA user_version\" finishes it");
}

/// Nothing is written beside a bag, so that read-only media work: without a write-ahead log the file is
/// immutable; with one, its index is kept in memory and it stays when the bag is closed.
Database opened(const std::string& file, const NamedBy& named_by) {
  refuse_journal(file, named_by);
  std::error_code none;
  const auto log_bytes = std::filesystem::file_size(file + "-wal", none);
  const bool has_log = !none && log_bytes > 0;
  sqlite3* raw = nullptr;
  const int code = has_log ? sqlite3_open_v2(file.c_str(), &raw, SQLITE_OPEN_READONLY, "unix-none")
                           : sqlite3_open_v2(immutable_uri(file).c_str(), &raw,
                                             SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  Database database(raw, &sqlite3_close);
  if (code != SQLITE_OK)
    throw named_by.error(file, "a file that cannot be read", "a bag of rosbag2 (sqlite3)");
  if (has_log) {
    sqlite3_db_config(raw, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    sqlite3_exec(raw, "PRAGMA locking_mode = EXCLUSIVE", nullptr, nullptr, nullptr);
  }
  return database;
}

/// Whether a column of a table is computed by an expression of the file.
bool has_computed_column(const Database& database, const char* table) {
  const Statement columns =
      prepared(database, ("PRAGMA main.table_xinfo(" + std::string(table) + ")").c_str());
  while (columns && sqlite3_step(columns.get()) == SQLITE_ROW)
    if (sqlite3_column_int(columns.get(), 6) != 0) return true;
  return false;
}

/// Throws unless the bag's tables are tables: not views, not virtual, and with stored columns alone.
void check_tables(const Database& database, const std::string& file, const NamedBy& named_by) {
  constexpr const char* kTables[] = {"topics", "messages", "message_definitions"};
  const Statement tables = prepared(database, "PRAGMA main.table_list");
  std::size_t found = 0;
  while (tables && sqlite3_step(tables.get()) == SQLITE_ROW) {
    const std::string name(bytes_of(tables, 1)), kind(bytes_of(tables, 2));
    const auto* wanted = std::ranges::find_if(
        kTables, [&](const char* table) { return sqlite3_stricmp(table, name.c_str()) == 0; });
    if (wanted == std::end(kTables)) continue;
    if (kind != "table")
      throw named_by.error(file, std::string(*wanted) + " is a " + kind,
                           "a bag of rosbag2 (sqlite3), whose topics and messages are tables",
                           "SQL of the file is not run");
    if (has_computed_column(database, *wanted))
      throw named_by.error(file, std::string(*wanted) + " has a computed column",
                           "a bag of rosbag2 (sqlite3), whose columns are stored",
                           "SQL of the file is not run");
    found += wanted < std::end(kTables) - 1 ? 1 : 0;
  }
  if (found < 2) throw named_by.error(file, "no tables of topics and messages", "a bag of rosbag2 (sqlite3)");
}

std::map<std::string, MessageChannel> definitions_of(const Database& database) {
  std::map<std::string, MessageChannel> definitions;
  const Statement rows =
      prepared(database, "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  while (rows && sqlite3_step(rows.get()) == SQLITE_ROW) {
    MessageChannel channel;
    channel.schema_encoding = bytes_of(rows, 1);
    channel.schema = bytes_of(rows, 2);
    definitions[std::string(bytes_of(rows, 0))] = std::move(channel);
  }
  return definitions;
}

}  // namespace

MessageDamage read_sqlite_bag(const std::string& file, const NamedBy& named_by,
                              const std::function<void(const MessageChannel&)>& on_channel,
                              const std::function<void(const TimedMessage&)>& on_message) {
  const std::int64_t size = size_of(file);
  std::int64_t calls_left = (kSteps + kStepsPerByte * size) / kStepsPerCall, bytes_left = size;
  const Database database = opened(file, named_by);
  restrain(database, calls_left);
  check_tables(database, file, named_by);
  const Statement topics = prepared(database, "SELECT id, name, type, serialization_format FROM topics");
  const Statement messages = prepared(database, kMessagesInOrder);
  if (!topics || !messages)
    throw named_by.error(file, "no tables of topics and messages", "a bag of rosbag2 (sqlite3)");
  const auto refuse_endless = [&] {
    if (calls_left < 0 || bytes_left < 0)
      throw named_by.error(file, "rows without end", "a bag with no more rows than its size holds");
  };
  const std::map<std::string, MessageChannel> definitions = definitions_of(database);
  refuse_endless();
  std::map<std::int64_t, std::size_t> channels;
  while (sqlite3_step(topics.get()) == SQLITE_ROW) {
    const std::string type(bytes_of(topics, 2));
    const auto defined = definitions.find(type);
    MessageChannel channel = defined == definitions.end() ? MessageChannel{} : defined->second;
    channel.topic = bytes_of(topics, 1);
    channel.type = type;
    channel.encoding = bytes_of(topics, 3);
    if (!channels.try_emplace(sqlite3_column_int64(topics.get(), 0), channels.size()).second) continue;
    on_channel(channel);
  }
  refuse_endless();
  MessageDamage damage;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(messages.get())) == SQLITE_ROW) {
    const std::string_view data = bytes_of(messages, 2);
    bytes_left -= static_cast<std::int64_t>(data.size());
    refuse_endless();
    const auto channel = channels.find(sqlite3_column_int64(messages.get(), 0));
    if (channel == channels.end()) {
      ++damage.broken_records;
      continue;
    }
    on_message({.channel = channel->second,
                .log_time_ns = static_cast<std::uint64_t>(sqlite3_column_int64(messages.get(), 1)),
                .data = data});
  }
  refuse_endless();
  damage.truncated = code != SQLITE_DONE;
  return damage;
}

}  // namespace joulepath
