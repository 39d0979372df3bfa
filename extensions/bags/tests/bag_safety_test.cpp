// A bag of somebody else: its SQL is not run, and what it takes is in proportion to its size.
#include <sqlite3.h>

#include <filesystem>
#include <fstream>

#include "extensions/bags/bag_file.hpp"
#include "extensions/bags/tests/bag_fixture.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath::testing {
namespace {

constexpr const char* kTopics = "topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT)";
constexpr const char* kMessageTable = "messages(topic_id INTEGER, timestamp INTEGER, data BLOB)";
constexpr const char* kEndless = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) ";

/// The messages of a bag, and the words of the error that ends reading.
struct Reading {
  std::size_t messages{}, bytes{};
  std::vector<std::uint64_t> times_ns{};
  std::string error{};
};

Reading reading(const std::string& file) {
  Reading seen;
  try {
    (void)read_bag(
        file, {}, [](const MessageChannel&) {},
        [&](const TimedMessage& message) {
          ++seen.messages;
          seen.bytes += message.data.size();
          seen.times_ns.push_back(message.log_time_ns);
        });
  } catch (const ConfigError& error) {
    seen.error = error.what();
  }
  return seen;
}

class ForeignBags : public Bags {
 protected:
  /// A database that these statements make.
  std::string database(const std::vector<std::string>& statements) {
    const std::string file = scratch_.at("foreign.db3");
    std::filesystem::remove(file);
    sqlite3* made = nullptr;
    sqlite3_open(file.c_str(), &made);
    for (const std::string& statement : statements)
      EXPECT_EQ(sqlite3_exec(made, statement.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << statement;
    sqlite3_close(made);
    return file;
  }
  static std::string table(const std::string& columns) { return "CREATE TABLE " + columns; }
};

TEST_F(ForeignBags, AnUnfinishedTransactionIsRefused) {
  const std::string bag = database({table(kTopics), table(kMessageTable)});
  std::ofstream(bag + "-journal") << "";
  EXPECT_EQ(reading(bag).error.find("-journal"), std::string::npos);
  std::ofstream(bag + "-journal") << "half";
  EXPECT_NE(reading(bag).error.find("an unfinished transaction in " + bag + "-journal"), std::string::npos);
}

/// With journal_mode PERSIST a finished journal stays, with zeros as its header.
TEST_F(ForeignBags, AFinishedJournalIsNoUnfinishedTransaction) {
  const std::string bag =
      database({std::string("PRAGMA journal_mode=PERSIST"), table(kTopics), table(kMessageTable)});
  ASSERT_GT(std::filesystem::file_size(bag + "-journal"), 0u);
  EXPECT_EQ(reading(bag).error.find("-journal"), std::string::npos);
}

/// Messages that are still in the write-ahead log are read; nothing is written beside the bag.
TEST_F(ForeignBags, WriteAheadLogsAreReadAndNothingIsWrittenBeside) {
  namespace fs = std::filesystem;
  const std::string open = scratch_.at("open.db3"), bag = scratch_.at("folder/bag.db3");
  fs::create_directories(scratch_.at("folder"));
  sqlite3* writer = nullptr;
  sqlite3_open(open.c_str(), &writer);
  for (const std::string& statement :
       {std::string("PRAGMA journal_mode=WAL"), table(kTopics), table(kMessageTable),
        std::string("INSERT INTO topics VALUES(1, '/odom', 'nav_msgs/msg/Odometry', 'cdr')"),
        std::string("INSERT INTO messages(topic_id, timestamp, data) VALUES(1, 5, x'00010000')")})
    EXPECT_EQ(sqlite3_exec(writer, statement.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << statement;
  const auto files = [&] {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(scratch_.at("folder")))
      names.push_back(entry.path().filename().string() + " " + std::to_string(entry.file_size()));
    std::ranges::sort(names);
    return names;
  };
  // As after a crash of the recorder, with its log, and as after its last checkpoint, without one.
  fs::copy_file(open, bag);
  fs::copy_file(open + "-wal", bag + "-wal");
  std::vector<std::string> before = files();
  EXPECT_EQ(reading(bag).messages, 1u) << reading(bag).error;
  EXPECT_EQ(files(), before);
  sqlite3_close(writer);
  fs::remove(bag + "-wal");
  fs::copy_file(open, bag, fs::copy_options::overwrite_existing);
  before = files();
  EXPECT_EQ(reading(bag).messages, 1u) << reading(bag).error;
  EXPECT_EQ(files(), before);
}

TEST_F(ForeignBags, BagsOfRos1NameTheConverter) {
  const std::string error = reading(scratch_.write("drive.bag", "#ROSBAG V2.0\n")).error;
  EXPECT_NE(error.find("found a bag of ROS 1"), std::string::npos) << error;
  EXPECT_NE(error.find("rosbags-convert"), std::string::npos) << error;
}

TEST_F(ForeignBags, ViewsInPlaceOfTablesAreRefused) {
  const std::string rows = std::string(" AS ") + kEndless;
  const std::vector<std::pair<std::string, std::string>> views{
      {table(kTopics),
       "CREATE VIEW messages" + rows + "SELECT 1 AS topic_id, x AS timestamp, zeroblob(100) AS data FROM c"},
      {table(kMessageTable),
       "CREATE VIEW Topics" + rows +
           "SELECT x AS id, 'n' || x AS name, 't' AS type, 'cdr' AS serialization_format FROM c"}};
  for (const auto& [first, view] : views) {
    const std::string error = reading(database({first, view})).error;
    EXPECT_NE(error.find(" is a view"), std::string::npos) << view << "\n" << error;
  }
  const std::string definitions =
      "CREATE VIEW message_definitions" + rows +
      "SELECT x AS topic_type, 'ros2msg' AS encoding, '' AS encoded_message_definition FROM c";
  EXPECT_NE(reading(database({table(kTopics), table(kMessageTable), definitions})).error.find("is a view"),
            std::string::npos);
}

TEST_F(ForeignBags, OtherSqlOfTheFileIsNotRun) {
  const std::string virtual_table = "CREATE VIRTUAL TABLE messages USING fts5(topic_id, timestamp, data)";
  EXPECT_NE(reading(database({table(kTopics), virtual_table})).error.find("is a virtual"), std::string::npos);
  for (const char* kind : {"VIRTUAL", "STORED"}) {
    const std::string computed =
        table(std::string("messages(topic_id INTEGER, timestamp INTEGER, data BLOB AS (zeroblob(90000)) ") +
              kind + ")");
    const Reading seen =
        reading(database({table(kTopics), computed, "INSERT INTO topics VALUES(1, 'a', 't', 'cdr')",
                          std::string("INSERT INTO messages ") + kEndless + "SELECT 1, x FROM c LIMIT 10"}));
    EXPECT_NE(seen.error.find("has a computed column"), std::string::npos) << seen.error;
    EXPECT_EQ(seen.messages, 0u);
  }
}

/// A database whose inner page at `page` names its first child in place of each.
std::string with_repeated_children(std::string bytes, std::size_t page) {
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at]));
  };
  EXPECT_EQ(byte(page), 5u) << "no inner page of a table";
  const std::size_t cells = byte(page + 3) << 8 | byte(page + 4);
  const std::size_t first = byte(page + 12) << 8 | byte(page + 13);
  for (std::size_t k = 0; k < cells; ++k) {
    const std::size_t cell = byte(page + 12 + 2 * k) << 8 | byte(page + 13 + 2 * k);
    for (std::size_t b = 0; b < 4; ++b) bytes[page + cell + b] = bytes[page + first + b];
  }
  return bytes;
}

TEST_F(ForeignBags, PagesThatRepeatGiveNoMoreThanTheFileHolds) {
  const std::string file =
      database({"PRAGMA page_size = 4096", table(kMessageTable), table(kTopics),
                "INSERT INTO topics VALUES(1, 'a', 't', 'cdr')",
                std::string("INSERT INTO messages ") + kEndless +
                    "SELECT 1, x, zeroblob(CASE x WHEN 1 THEN 1000000 ELSE 3000 END) FROM c LIMIT 200"});
  EXPECT_EQ(reading(file).messages, 200u);
  std::ifstream stream(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const Reading seen = reading(written(with_repeated_children(whole, 4096), "repeated.db3"));
  EXPECT_LE(seen.bytes, whole.size());
  EXPECT_NE(seen.error.find("rows without end"), std::string::npos) << seen.error;
}

TEST_F(ForeignBags, RowsComeInTheOrderOfTimeWithAndWithoutAnIndex) {
  const std::vector<std::string> bag{table(kTopics), table(kMessageTable),
                                     "INSERT INTO topics VALUES(1, 'a', 't', 'cdr')",
                                     "INSERT INTO messages VALUES(1, 30, 'c'), (1, 10, 'a'), (1, 20, 'b')"};
  const std::vector<std::uint64_t> sorted{10, 20, 30};
  EXPECT_EQ(reading(database(bag)).times_ns, sorted);
  std::vector<std::string> indexed = bag;
  indexed.emplace_back("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  EXPECT_EQ(reading(database(indexed)).times_ns, sorted);
}

/// A chunk of the fixture's format, `count` times the same, from `records`.
std::string repeated_chunk(const std::string& records, std::size_t count) {
  const std::string whole = drive(),
                    plain = whole.substr(0, 8) + records + whole.substr(whole.size() - 8 - 29 - 13);
  const std::string one = chunked(plain, "zstd");
  const std::string chunk = one.substr(8, one.size() - 8 - 8 - 29 - 13);
  std::string bag = one.substr(0, 8);
  for (std::size_t k = 0; k < count; ++k) bag += chunk;
  return bag + one.substr(one.size() - 8 - 29 - 13);
}

std::string record(char kind, const std::string& content) {
  std::string bytes(1, kind);
  put(bytes, static_cast<std::uint64_t>(content.size()));
  return bytes + content;
}

/// Schema, channel and `count` equal messages of the fixture's drive.
std::string messages_without_end(std::size_t count) {
  const std::string whole = drive();
  std::string records, message;
  for (std::size_t at = 8; whole[at] != '\x0F'; at += 9 + number_at<std::uint64_t>(whole, at + 1)) {
    const std::string one = whole.substr(at, 9 + number_at<std::uint64_t>(whole, at + 1));
    if (whole[at] == '\x03' || whole[at] == '\x04') records += one;
    if (whole[at] == '\x05') message = one;
  }
  for (std::size_t k = 0; k < count; ++k) records += message;
  return records;
}

TEST_F(ForeignBags, ManyChunksAreBoundedTogether) {
  // 100 kB hold 40 chunks of 10,000 messages: refused at the bound on messages, long before 400,000 of them.
  const std::string bag = repeated_chunk(messages_without_end(10'000), 40);
  const Reading seen = reading(written(bag));
  EXPECT_NE(seen.error.find("more messages than"), std::string::npos)
      << bag.size() << " bytes: " << seen.error;
  EXPECT_LE(seen.messages, bag.size() + 100'000);
}

TEST_F(ForeignBags, ChunksWithoutMessagesAreBoundedToo) {
  // 20 kB hold 30 chunks of 16 MiB that no reader keeps.
  const std::string bag = repeated_chunk(record('\x0C', std::string(std::size_t{16} << 20, '\0')), 30);
  const Reading seen = reading(written(bag));
  EXPECT_LT(bag.size(), 100'000u);
  EXPECT_NE(seen.error.find("1000 times"), std::string::npos) << seen.error;
}

TEST_F(ForeignBags, AFileIsReadOnceAsTheMetadataNamesIt) {
  std::filesystem::create_directories(scratch_.at("bag"));
  written(drive(), "bag/a.mcap");
  written("rosbag2_bagfile_information: {relative_file_paths: [a.mcap, a.mcap]}\n", "bag/metadata.yaml");
  EXPECT_NE(reading(scratch_.at("bag")).error.find("each file once"), std::string::npos);
}

/// rosbag2 numbers its files: the tenth comes after the ninth.
TEST_F(ForeignBags, AFolderWithoutMetadataIsReadInTheOrderOfItsNumbers) {
  std::filesystem::create_directories(scratch_.at("bag"));
  const auto part = [&](const std::string& name, int time_ns) {
    std::filesystem::rename(
        database({table(kTopics), table(kMessageTable), "INSERT INTO topics VALUES(1, 'a', 't', 'cdr')",
                  "INSERT INTO messages VALUES(1, " + std::to_string(time_ns) + ", 'x')"}),
        scratch_.at("bag/" + name));
  };
  part("run_10.db3", 30), part("run_9.db3", 20);
  EXPECT_EQ(reading(scratch_.at("bag")).times_ns, (std::vector<std::uint64_t>{20, 30}));
}

TEST_F(ForeignBags, DeepAndLongLinesAreNoStates) {
  const std::string state =
      R"({"timestamp": "2026-05-01T10:00:10Z", "serialNumber": "agv", "velocity": {"vx": 0.1}, "batteryState": {}})";
  std::string deep = state;
  deep.insert(deep.size() - 1, R"(, "x": )" + std::string(100'000, '[') + std::string(100'000, ']'));
  const std::string longest = std::string((16u << 20) - state.size(), ' ') + state;
  const std::string longer = std::string((16u << 20) + 1, ' ') + state;
  for (const auto& [line, states] : {std::pair{deep, 2u}, {longest, 3u}, {longer, 2u}}) {
    const Reading seen = reading(written(state + "\n" + line + "\n" + state + "\n", "run.jsonl"));
    EXPECT_EQ(seen.messages, states) << seen.error;
  }
}

TEST(ShallowJson, DepthIsCountedOutsideOfTexts) {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + "1" + std::string(depth, ']');
  };
  EXPECT_FALSE(shallow_json(nested(64)).is_discarded());
  EXPECT_TRUE(shallow_json(nested(65)).is_discarded());
  EXPECT_TRUE(shallow_json(std::string(5'000'000, '[')).is_discarded());
  EXPECT_FALSE(
      shallow_json("[\"" + std::string(100, '[') + "\\\"" + std::string(100, '{') + "\"]").is_discarded());
  EXPECT_FALSE(shallow_json("[" + std::string(200, ' ') + "[1], [2], {\"a\": [3]}]").is_discarded());
}

}  // namespace
}  // namespace joulepath::testing
