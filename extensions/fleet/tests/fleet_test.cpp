// The files of tests/data/broken/fleet hold the mistakes of fleet files; here are the energies of their legs.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "extensions/fleet/fleet_file.hpp"
#include "extensions/fleet/leg_energies.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const FleetFloor& good_floor() {
  static const FleetFloor floor =
      read_fleet_floor(read_fleet(JOULEPATH_SOURCE_DIR "/tests/data/broken/good/fleet.yaml"));
  return floor;
}

std::vector<LegPoint> leg(const std::string& from, const std::string& to, double payload_kg) {
  return leg_points(good_floor(), {0, from, to, payload_kg}, {});
}

TEST(LegEnergies, AQuickerPointTakesMoreEnergy) {
  const auto points = leg("dock", "shelf", 0.0);
  ASSERT_GE(points.size(), 2u);
  for (std::size_t k = 1; k < points.size(); ++k) {
    EXPECT_LT(points[k].duration_s, points[k - 1].duration_s);
    EXPECT_GT(points[k].motion_J, points[k - 1].motion_J);
  }
  for (const LegPoint& point : points) EXPECT_GT(point.sigma_J, 0.0);
}

TEST(LegEnergies, TheMarginIsTheModelsErrorBesideThatOfTheConstants) {
  const LegPoint cheapest = leg("dock", "shelf", 0.0).front();
  EXPECT_GT(cheapest.sigma_J, 0.05 * cheapest.motion_J);                     // energy_margin: 0.05
  EXPECT_LT(cheapest.sigma_J, std::hypot(0.05, 0.015) * cheapest.motion_J);  // friction_torque_Nm: 0.015
}

TEST(LegEnergies, APayloadTakesMoreEnergy) {
  EXPECT_GT(leg("dock", "shelf", 10.0).front().motion_J, leg("dock", "shelf", 0.0).front().motion_J);
}

TEST(LegEnergies, DirectionsDiffer) {  // the dock has a heading, the shelf has none
  EXPECT_NE(leg("dock", "shelf", 0.0).front().motion_J, leg("shelf", "dock", 0.0).front().motion_J);
}

TEST(LegEnergies, ALegToItsStartIsNothing) {
  const auto points = leg("dock", "dock", 5.0);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points.front().motion_J, 0.0);
  EXPECT_EQ(points.front().duration_s, 0.0);
}

TEST(FleetFile, NumbersOfRobotsAndTheirBatteries) {
  const auto json = nlohmann::json::parse(fleet_json(good_floor()));
  EXPECT_EQ(json["robots"].size(), 2u);
  EXPECT_EQ(json["types"].size(), 1u);  // both robots have one file
  EXPECT_DOUBLE_EQ(json["types"][0]["capacity_J"], 240.0 * 3600.0);
  EXPECT_EQ(json["missions"][0]["robots"], (std::vector<int>{0, 1}));
  EXPECT_TRUE(json["robots"][0]["to_s"].is_null());
}

TEST(FleetFile, AShiftShorterThanEveryMissionAndAWeakChargerAreNoted) {
  Fleet fleet = read_fleet(JOULEPATH_SOURCE_DIR "/scenarios/fleets/night_shift.yaml");
  EXPECT_TRUE(fleet_notes(fleet).empty());
  fleet.robots[1].to_s = 8;
  fleet.chargers[0].power_W = 0.2;
  const std::vector<std::string> notes = fleet_notes(fleet);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].rfind("chargers[0].power_W: 0.2 W charge no robot", 0), 0u) << notes[0];
  EXPECT_EQ(notes[1].rfind("robots[1].to_s: a shift of 8 s", 0), 0u) << notes[1];
}

TEST(FleetFile, ARobotThatMayNotCarryAPayloadIsLeftOut) {
  FleetMission mission = good_floor().fleet.missions.front();
  EXPECT_TRUE(may_drive(good_floor(), 0, mission));
  mission.stops.front().payload_kg = 13.0;  // limits.max_payload_kg: 12
  EXPECT_FALSE(may_drive(good_floor(), 0, mission));
  mission.stops.front().payload_kg = 2.0;
  mission.robots = {"b"};
  EXPECT_FALSE(may_drive(good_floor(), 0, mission));
  EXPECT_TRUE(may_drive(good_floor(), 1, mission));
}

}  // namespace
}  // namespace joulepath
