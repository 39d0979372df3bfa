#include "scenarios/bags/sqlite_bag.hpp"

#include <sqlite3.h>

#include <map>
#include <memory>

namespace joulepath {
namespace {

constexpr int kMostRowBytes = 256 << 20;

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

Database opened(const std::string& file, const NamedBy& named_by) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &raw, SQLITE_OPEN_READONLY, nullptr);
  Database database(raw, &sqlite3_close);
  if (code != SQLITE_OK)
    throw named_by.error(file, "a file that cannot be read", "a bag of rosbag2 (sqlite3)");
  sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, kMostRowBytes);
  return database;
}

std::map<std::string, BagChannel> definitions_of(const Database& database) {
  std::map<std::string, BagChannel> definitions;
  const Statement rows =
      prepared(database, "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  while (rows && sqlite3_step(rows.get()) == SQLITE_ROW) {
    BagChannel channel;
    channel.schema_encoding = bytes_of(rows, 1);
    channel.schema = bytes_of(rows, 2);
    definitions[std::string(bytes_of(rows, 0))] = std::move(channel);
  }
  return definitions;
}

}  // namespace

BagDamage read_sqlite_bag(const std::string& file, const NamedBy& named_by,
                          const std::function<void(const BagChannel&)>& on_channel,
                          const std::function<void(const BagMessage&)>& on_message) {
  const Database database = opened(file, named_by);
  const Statement topics = prepared(database, "SELECT id, name, type, serialization_format FROM topics");
  const Statement messages =
      prepared(database, "SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp");
  if (!topics || !messages)
    throw named_by.error(file, "no tables of topics and messages", "a bag of rosbag2 (sqlite3)");
  const std::map<std::string, BagChannel> definitions = definitions_of(database);
  std::map<std::int64_t, std::size_t> channels;
  while (sqlite3_step(topics.get()) == SQLITE_ROW) {
    const std::string type(bytes_of(topics, 2));
    const auto defined = definitions.find(type);
    BagChannel channel = defined == definitions.end() ? BagChannel{} : defined->second;
    channel.topic = bytes_of(topics, 1);
    channel.type = type;
    channel.encoding = bytes_of(topics, 3);
    if (!channels.try_emplace(sqlite3_column_int64(topics.get(), 0), channels.size()).second) continue;
    on_channel(channel);
  }
  BagDamage damage;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(messages.get())) == SQLITE_ROW) {
    const auto channel = channels.find(sqlite3_column_int64(messages.get(), 0));
    if (channel == channels.end()) {
      ++damage.broken_records;
      continue;
    }
    on_message({.channel = channel->second,
                .log_time_ns = static_cast<std::uint64_t>(sqlite3_column_int64(messages.get(), 1)),
                .data = bytes_of(messages, 2)});
  }
  damage.truncated = code != SQLITE_DONE;
  return damage;
}

}  // namespace joulepath
