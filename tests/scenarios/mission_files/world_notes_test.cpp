#include "scenarios/mission_files/world_notes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenarios/any_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/path_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

const std::string kDepotRound = JOULEPATH_SOURCE_DIR "/scenarios/missions/depot_round.yaml";
const std::string kNomadFile = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";

/// The notes that a change of the depot's mission, or of its files, adds.
template <class Change>
std::vector<std::string> added_notes(const Change& change) {
  MissionRequest mission = read_mission(kDepotRound);
  MissionWorld world = read_world(mission);
  const std::size_t before = world_notes(mission, world).size();
  change(mission, world);
  std::vector<std::string> notes = world_notes(mission, world);
  notes.erase(notes.begin(), notes.begin() + static_cast<std::ptrdiff_t>(std::min(before, notes.size())));
  return notes;
}

bool tells(const std::vector<std::string>& notes, const std::string& words) {
  return notes.size() == 1 && notes[0].find(words) != std::string::npos;
}

TEST(WorldNotes, ASpeedCapFarAboveTheRobotsLimitIsNoted) {
  const auto notes_at = [](double speed_m_s) {
    return added_notes([&](MissionRequest& mission, MissionWorld&) {
      mission.speed_zones = {
          {.from_m = 1,
           .to_m = 2,
           .speed_m_s = speed_m_s,
           .marks = {.path = "speed_zones[0]", .keys = {{"speed_m_s", {"m.yaml", 9, 1}}}}}};
    });
  };
  EXPECT_TRUE(tells(notes_at(50), "m.yaml:9: speed_zones[0].speed_m_s 50 m/s has no effect"));
  EXPECT_TRUE(notes_at(2).empty()) << "an order for faster robots";
}

TEST(WorldNotes, CellsAsWideAsTheRobotAreNoted) {
  const auto notes_at = [](double resolution_m) {
    return added_notes([&](MissionRequest&, MissionWorld& world) { world.map->resolution_m = resolution_m; });
  };
  EXPECT_TRUE(tells(notes_at(0.5), "resolution: a cell of 0.5 m is not smaller than the robot"));
  EXPECT_TRUE(notes_at(0.1).empty());
  EXPECT_TRUE(notes_at(5).empty()) << "the map file's own note tells it";
}

TEST(WorldNotes, ARouteGraphOutsideOfTheMapIsNoted) {
  const auto notes_at = [](double shift_m) {
    return added_notes([&](MissionRequest&, MissionWorld& world) {
      world.route_graph =
          RouteGraph{.nodes = {{1, 1.5 + shift_m, 7.5}, {2, 22.2 + shift_m, 4.9}, {3, 17 + shift_m, 3.9}}};
    });
  };
  EXPECT_TRUE(notes_at(0).empty());
  EXPECT_TRUE(tells(notes_at(-40), "3 of 3 nodes"));
}

TEST(WorldNotes, ARobotsImplausibleConstantIsToldOfItsFile) {
  const std::vector<std::string> notes =
      added_notes([](MissionRequest&, MissionWorld& world) { world.robot.power.standby_W *= 1000; });
  MissionRequest mission = read_mission(kDepotRound);
  MissionWorld world = read_world(mission);
  world.robot.power.standby_W *= 1000;
  EXPECT_EQ(notes.size(), 1u);
  EXPECT_EQ(world_notes(mission, world).front().rfind(mission.robot_file + ": power.standby_W", 0), 0u);
}

/// Those that the core reads.
TEST(WorldNotes, TheShippedMissionsHaveNone) {
  for (const std::string name : {"depot_round", "warehouse_pick"}) {
    const MissionRequest mission = read_mission(JOULEPATH_SOURCE_DIR "/scenarios/missions/" + name + ".yaml");
    EXPECT_EQ(world_notes(mission, read_world(mission)), std::vector<std::string>{}) << name;
  }
}

TEST(WorldNotes, PointsOfAPathThatAreFarApartAreNoted) {
  const ScratchDirectory scratch;
  std::vector<std::string> in_cm, in_m;
  static_cast<void>(read_waypoints(scratch.write("cm.csv", "x_m,y_m\n0,0\n200,0\n400,0\n"), {}, {}, &in_cm));
  static_cast<void>(read_waypoints(scratch.write("m.csv", "x_m,y_m\n0,0\n2,0\n4,1\n"), {}, {}, &in_m));
  EXPECT_TRUE(tells(in_cm, "in cm, or in mm?"));
  EXPECT_TRUE(in_m.empty());
}

TEST(AnyFile, EachLineOfAListOfMissionsIsChecked) {
  const ScratchDirectory scratch;
  const auto line = [](const std::string& key) {
    return R"({"schema": "joulepath/mission/1", "robot": ")" + kNomadFile +
           R"(", "legs": [{"motion": {"profile": "stand", ")" + key + R"(": 5}}]})" + "\n";
  };
  const FileSummary sound = read_any_file(scratch.write("a.jsonl", line("duration_s") + line("duration_s")));
  EXPECT_EQ(sound.text, "2 missions");
  const FileSummary broken =
      read_any_file(scratch.write("b.jsonl", line("duration_s") + line("duration") + line("time")));
  ASSERT_EQ(broken.errors.size(), 2u);
  EXPECT_EQ(broken.errors[0].detail().mark.line, 2);
  EXPECT_EQ(broken.errors[0].detail().key, "/legs/0/motion/duration");
  EXPECT_EQ(broken.errors[1].detail().mark.line, 3);
}

}  // namespace
}  // namespace joulepath
