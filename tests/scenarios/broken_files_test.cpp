#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <vector>

#include "model/effects/catalog.hpp"
#include "model/limit_table.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/file_kinds.hpp"
#include "scenarios/registry.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kBroken = JOULEPATH_SOURCE_DIR "/tests/data/broken/";

/// Lists of names that are tables of the program: `<limits>` in the file stands for all keys of limits.
std::map<std::string, std::string> names_of_tables() {
  std::vector<std::string> limits, by_payload, effects, schemas;
  for (const Limit& row : kLimits) {
    if (row.field == nullptr || !row.in_limits) continue;
    limits.emplace_back(row.key);
    if (row.by_payload) by_payload.emplace_back(row.key);
  }
  for (const EffectDescription& effect : effect_catalog()) effects.emplace_back(effect.info.name);
  for (const FileKind& kind : file_kinds()) schemas.push_back("joulepath/" + kind.name + "/1");
  return {{"<kinds>", checked_kinds()},
          {"<limits>", text_of_list(limits)},
          {"<limits by payload>", text_of_list(by_payload)},
          {"<effects>", text_of_list(effects)},
          {"<schemas>", text_of_list(schemas)}};
}

std::map<std::string, std::string> expected_messages() {
  std::map<std::string, std::string> messages;
  const auto tables = names_of_tables();
  std::ifstream stream(kBroken + "expected.tsv");
  for (std::string line; std::getline(stream, line);) {
    for (const auto& [table, names] : tables)
      if (const auto at = line.find(table); at != std::string::npos) line.replace(at, table.size(), names);
    const auto tab = line.find('\t');
    messages[line.substr(0, tab)] = line.substr(tab + 1);
  }
  return messages;
}

std::string without(std::string text, const std::string& part) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

/// Where an extension was not built, its files say so.
bool needs_absent_extension(const ConfigError& error) {
  return std::ranges::any_of(known_additions(), [&](const Addition& addition) {
    return !addition.is_built && error.detail().accepted == accepted_extension(addition.extension);
  });
}

TEST(BrokenFiles, EachGivesItsOwnMessage) {
  const auto messages = expected_messages();
  ASSERT_GE(messages.size(), 100u);
  for (const auto& [file, expected] : messages) {
    try {
      const auto summary = read_any_file(kBroken + file);
      ADD_FAILURE() << file << " was taken as " << summary.kind << " " << summary.text;
    } catch (const ConfigError& error) {
      if (needs_absent_extension(error)) continue;
      EXPECT_EQ(without(error.what(), kBroken), expected) << file;
      EXPECT_FALSE(error.detail().found.empty()) << file;
      EXPECT_FALSE(error.detail().accepted.empty()) << file;
    }
  }
}

TEST(BrokenFiles, TheUnbrokenFilesAreValid) {
  for (const char* file :
       {"robot.yaml", "mission.yaml", "visit.yaml", "map.yaml", "dataset.yaml", "fleet.yaml", "run.csv",
        "graph.geojson", "order.json", "path.yaml", "waypoints.csv", "corners.csv"})
    try {
      static_cast<void>(read_any_file(kBroken + "good/" + file));
    } catch (const ConfigError& error) {
      EXPECT_TRUE(needs_absent_extension(error)) << file << ": " << error.what();
    }
}

TEST(AnyFile, ALogWithPositionsIsNotAPath) {
  const ScratchDirectory scratch;
  const auto kind_of = [&](const std::string& name, const std::string& text) {
    return read_any_file(scratch.write(name, text)).kind;
  };
  const std::string wheels = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s";
  EXPECT_EQ(kind_of("both.csv", wheels + ",x_m,y_m\n0,1,1,0,0\n0.1,1,1,0.1,0\n0.2,1,1,0.2,0\n"), "run log");
  EXPECT_EQ(kind_of("one.csv", wheels + ",x_m\n0,1,1,0\n0.1,1,1,0.1\n0.2,1,1,0.2\n"), "run log");
  EXPECT_EQ(kind_of("words.csv", wheels + ",x_m\n0,1,1,?\n0.1,1,1,?\n0.2,1,1,?\n"), "run log");
  EXPECT_EQ(kind_of("path.csv", "x_m,y_m\n0,0\n0.1,0\n0.2,0\n"), "path");
}

TEST(AnyFile, StopsAndTurnsOfAPathAreNoted) {
  const ScratchDirectory scratch;
  const auto notes_of = [&](const std::string& curves) {
    return read_any_file(scratch.write("path.yaml", "bezier_m: [" + curves + "]\n")).notes;
  };
  const std::string straight = "[[0, 0], [1, 0], [2, 0], [3, 0]]";
  const auto stop = notes_of(straight + ", [[3, 0], [4, 0], [5, 1], [5, 2]]");
  ASSERT_EQ(stop.size(), 1u);
  EXPECT_EQ(stop.front(), "curve 1 at (3, 0) m: curvature jumps by 0.6667 1/m, stop");
  const auto turn = notes_of(straight + ", [[3, 0], [3, 1], [3, 2], [3, 3]]");
  ASSERT_EQ(turn.size(), 1u);
  EXPECT_EQ(turn.front(), "curve 1 at (3, 0) m: heading breaks by 1.571 rad, turn in place");
  EXPECT_TRUE(notes_of(straight + ", [[3, 0], [4, 0], [5, 0], [6, 0]]").empty());
}

TEST(BrokenFiles, EveryFileOfTheCorpusIsExpected) {
  const auto messages = expected_messages();
  const std::set<std::string> parts{
      "map/truncated.pgm",     "map/truncated_text.pgm",  "map/above_white.pgm",   "map/no_pixels.pgm",
      "map/too_large.pgm",     "map/broken.png",          "map/empty.pgm",         "dataset/later.csv",
      "dataset/run_again.csv", "dataset/clock_jumps.csv", "fleet/sure_robot.yaml", "fleet/reserve_robot.yaml",
      "expected.tsv"};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kBroken)) {
    const std::string name = entry.path().string().substr(kBroken.size());
    if (entry.is_directory() || name.rfind("good/", 0) == 0 || parts.contains(name)) continue;
    EXPECT_TRUE(messages.contains(name)) << name;
  }
}

TEST(UntrustedFiles, NamesMayNotLeaveTheFolder) {
  const ScratchDirectory scratch;
  const auto key_refused = [&](const std::string& image) {
    const std::string file = scratch.write(
        "in/map.yaml",
        "image: " + image + "\nresolution: 1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.25\n");
    static_cast<void>(read_any_file(file));  // as trusted input, every one of them is valid
    try {
      static_cast<void>(read_any_file(file, "", {.untrusted = true}));
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().accepted, "a path inside of the input's folder");
      return error.detail().key;
    }
    return std::string();
  };
  const std::string outside = scratch.write("m.pgm", "P2 1 1 255 0");
  scratch.write("in/m.pgm", "P2 1 1 255 0");
  std::filesystem::create_symlink(outside, scratch.at("in/link.pgm"));
  EXPECT_EQ(key_refused("m.pgm"), "");
  EXPECT_EQ(key_refused("../in/m.pgm"), "");
  EXPECT_EQ(key_refused("../m.pgm"), "image");
  EXPECT_EQ(key_refused(outside), "image");
  EXPECT_EQ(key_refused("link.pgm"), "image");
}

}  // namespace
}  // namespace joulepath
