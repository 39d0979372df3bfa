#include "scenarios/text/csv_table.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <random>

#include "scenarios/log_files/run_log.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

const auto kAll = [](const std::string&) { return true; };

TEST(CsvTable, SeparatorsQuotesLineEndsMarksAndCommentsAreAllTheSameTable) {
  const std::vector<std::vector<double>> expected{{1, 3}, {-2.5, 4e-3}};
  for (const char* text : {"a,b\n1,-2.5\n3,4e-3\n", "a;b\r\n1;-2.5\r\n3;4e-3", "a\tb\n1\t-2.5\n\n3\t4e-3\n",
                           "\xEF\xBB\xBF\"a\",\"b\"\n\"1\",\"-2.5\"\n3,4e-3\n",
                           "# made by hand\na,b\n 1 , -2.5\n# pause\n+3,+4e-3\n"})
    EXPECT_EQ(parse_csv(text, "t.csv", kAll).columns, expected) << text;
}

TEST(CsvTable, EmptyCellsAreMissingValues) {
  const CsvTable table = parse_csv("a,b\n1,\n,2\n", "t.csv", kAll);
  EXPECT_TRUE(std::isnan(table.columns[1][0]));
  EXPECT_TRUE(std::isnan(table.columns[0][1]));
  EXPECT_EQ(table.line_of_row, (std::vector<int>{2, 3}));
}

TEST(CsvTable, DatesInAColumnOfTimesAreSeconds) {
  const CsvTable table = parse_csv(
      "time\n1970-01-01T00:00:00Z\n2024-02-29 12:30:15.25\n2024-02-29T14:30:15.25+02:00\n", "t.csv", kAll);
  EXPECT_EQ(table.columns[0], (std::vector<double>{0, 1709209815.25, 1709209815.25}));
  for (const char* text :
       {"time\n2023-02-29T00:00:00Z\n", "time\n2024-02-29T25:00:00Z\n", "speed\n2024-02-28T00:00:00Z\n"})
    EXPECT_THROW(static_cast<void>(parse_csv(text, "t.csv", kAll)), ConfigError) << text;
}

TEST(CsvTable, UnrequestedColumnsMayContainAnything) {
  const CsvTable table = parse_csv("note,a,note\n\"x, y\",1,nan\nz,2,\n", "t.csv",
                                   [](const std::string& name) { return name == "a"; });
  EXPECT_EQ(*table.find("a"), (std::vector<double>{1, 2}));
}

TEST(CsvTable, NumbersReadBackToTheLastBit) {
  std::mt19937_64 random(7);
  std::string text = "a\n";
  std::vector<double> numbers;
  while (numbers.size() < 2000) {
    const auto bits = random();
    double value;
    static_assert(sizeof value == sizeof bits);
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    char buffer[32];
    text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr) += '\n';
    numbers.push_back(value);
  }
  EXPECT_EQ(parse_csv(text, "t.csv", kAll).columns[0], numbers);
}

/// A good log, damaged at random places: the reader returns a table or throws a ConfigError, never anything
/// else.
TEST(CsvTable, DamagedLogsAreReadOrRefusedButNeverBreakTheReader) {
  std::mt19937 random(11);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::string good =
      "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,orientation_w,orientation_z,battery_voltage_V\n";
  for (int i = 0; i < 40; ++i)
    good += std::to_string(0.1 * i) + "," + std::to_string(i % 7) + ",-1.5e0,1,0,24.0\n";
  const std::string pool = "0123456789.,;\n\r\t\"'#+-eEnaif \xff\x80%_";
  const ScratchDirectory scratch;
  int read = 0, refused = 0;
  for (int trial = 0; trial < 600; ++trial) {
    std::string text = good;
    for (std::size_t n = 1 + pick(4); n > 0 && !text.empty(); --n) {
      const std::size_t at = pick(text.size()), length = 1 + pick(20);
      switch (pick(5)) {
        case 0:
          text[at] = pool[pick(pool.size())];
          break;
        case 1:
          text.insert(at, 1, pool[pick(pool.size())]);
          break;
        case 2:
          text.erase(at, length);
          break;
        case 3:
          text.insert(at, text.substr(pick(text.size()), length));
          break;
        default:
          text.resize(at + 1);
          break;
      }
    }
    try {
      const RunLog log = read_run_log(scratch.write("log.csv", text),
                                      Geometry{.wheel_radius_m = {0.1, 0.1}, .half_track_m = 0.2});
      const Trajectory& t = log.trajectory;
      ASSERT_EQ(t.wheel_speed_rad_s.left.size(), t.size());
      for (std::size_t i = 0; i < t.size(); ++i) {
        ASSERT_TRUE(std::isfinite(t.time_s[i]) && std::isfinite(t.wheel_speed_rad_s.left[i]) &&
                    std::isfinite(t.wheel_speed_rad_s.right[i]));
        if (i > 0) {
          ASSERT_GT(t.time_s[i], t.time_s[i - 1]);
        }
      }
      ++read;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("found "), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace joulepath
