#include "scenarios/mission_files/map_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/text/image.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

const std::string kMaps = JOULEPATH_SOURCE_DIR "/scenarios/maps/";

std::string map_yaml(const std::string& image, const std::string& more) {
  return "image: " + image + "\nresolution: 0.5\norigin: [1, 2, 0]\n" + more;
}

TEST(MapFile, WarehouseIsFreeAtItsStationsAndWalledAround) {
  const OccupancyGrid grid = read_map(kMaps + "warehouse.yaml");
  EXPECT_EQ(grid.width, 1006);
  EXPECT_EQ(grid.height, 1674);
  EXPECT_EQ(grid.at(grid.cell_of(2.0, -23.5)), 0);
  EXPECT_EQ(grid.at(grid.cell_of(12.45, -16.25)), 0);
  EXPECT_GT(std::count(grid.occupancy_percent.begin(), grid.occupancy_percent.end(), 100), 1000);
  EXPECT_FALSE(grid.contains(grid.cell_of(-16, 0)));
}

TEST(MapFile, EveryNav2MapReads) {
  for (const char* name : {"warehouse_keepout.yaml", "warehouse_speed.yaml", "depot.yaml"})
    EXPECT_FALSE(read_map(kMaps + name).occupancy_percent.empty()) << name;
}

/// A mission may take unknown cells for floor; occupied cells stay.
TEST(MapFile, UnknownCellsAreFloorWhereTheMissionSaysSo) {
  const ScratchDirectory scratch;
  scratch.write("m.pgm", "P2\n3 1\n255\n0 205 254\n");
  scratch.write("m.yaml", map_yaml("m.pgm", "occupied_thresh: 0.65\nfree_thresh: 0.1\n"));
  const auto cells = [&](const std::string& unknown) {
    return read_world(
               read_mission(scratch.write(
                   "mission.yaml", "robot: " JOULEPATH_SOURCE_DIR
                                   "/scenarios/robots/nomad_super_scout.yaml\nmap: m.yaml\n" +
                                       unknown + "stations: {a: {x_m: 1, y_m: 2}}\nlegs: [{to: a}]\n")))
        .map->occupancy_percent;
  };
  EXPECT_EQ(cells(""), (std::vector<std::int8_t>{100, kUnknownCell, 0}));
  EXPECT_EQ(cells("unknown: occupied\n"), cells(""));
  EXPECT_EQ(cells("unknown: free\n"), (std::vector<std::int8_t>{100, 0, 0}));
}

TEST(MapFile, FirstImageRowIsTheTopOfTheMap) {
  const ScratchDirectory scratch;
  scratch.write("m.pgm", "P2\n# a comment\n2 2\n255\n0 254\n254 254\n");
  const auto grid =
      read_map(scratch.write("m.yaml", map_yaml("m.pgm", "occupied_thresh: 0.65\nfree_thresh: 0.25\n")));
  EXPECT_EQ(grid.at({0, 1}), 100);
  EXPECT_EQ(grid.at({0, 0}), 0);
  EXPECT_EQ(grid.at(grid.cell_of(1.2, 2.9)), 100);  // upper left
}

TEST(MapFile, ThresholdsMakeThreeKindsOfCell) {
  const ScratchDirectory scratch;
  scratch.write("m.pgm", "P2 3 1 255 254 128 0");
  const auto file = scratch.write("m.yaml", map_yaml("m.pgm", "occupied_thresh: 0.65\nfree_thresh: 0.25\n"));
  EXPECT_EQ(read_map(file).occupancy_percent, (std::vector<std::int8_t>{0, kUnknownCell, 100}));
  for (const char* negate : {"1", "true"}) {
    const auto negated = scratch.write(
        "n.yaml",
        map_yaml("m.pgm", std::string("negate: ") + negate + "\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"));
    EXPECT_EQ(read_map(negated).occupancy_percent, (std::vector<std::int8_t>{100, kUnknownCell, 0}))
        << negate;
  }
}

/// Map savers write unknown cells as grey 205, which 0.25 counts as free and 0.196 does not.
TEST(MapFile, FreeFloorThatWasSavedAsUnknownIsNoted) {
  const ScratchDirectory scratch;
  scratch.write("m.pgm", "P2 4 1 255 254 205 0 0");
  const auto notes = [&](const std::string& more) {
    return map_notes(scratch.write("m.yaml", map_yaml("m.pgm", "occupied_thresh: 0.65\n" + more)));
  };
  ASSERT_EQ(notes("free_thresh: 0.25\n").size(), 1u);
  EXPECT_NE(notes("free_thresh: 0.25\n")[0].find("25 % of the cells"), std::string::npos);
  for (const char* sound :
       {"free_thresh: 0.196\n", "free_thresh: 0.25\nmode: raw\n", "free_thresh: 0.25\nnegate: 1\n"})
    EXPECT_TRUE(notes(sound).empty()) << sound;
}

/// A room of 20 by 20 cells with a wall around it; without the wall it may be the drawing of a lane.
TEST(MapFile, AMapWhoseFloorIsOccupiedIsNoted) {
  const ScratchDirectory scratch;
  std::string room = "P2 20 20 255", lane = room;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column) {
      const bool wall = row == 0 || row == 19 || column == 0 || column == 19;
      room += wall ? " 0" : " 254";
      lane += row == 10 ? " 254" : " 0";
    }
  scratch.write("m.pgm", room);
  const auto notes = [&](const std::string& negate) {
    return map_doubts(scratch.write(
        "m.yaml", map_yaml("m.pgm", "occupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: " + negate + "\n")));
  };
  EXPECT_TRUE(notes("0").empty());
  ASSERT_EQ(notes("1").size(), 1u);
  EXPECT_EQ(notes("1")[0].rfind("negate: 1 makes 81 %", 0), 0u) << notes("1")[0];
  scratch.write("m.pgm", lane);
  EXPECT_TRUE(notes("0").empty());
}

TEST(MapFile, KeysThatNav2IgnoresAreNotedNotRefused) {
  const ScratchDirectory scratch;
  scratch.write("m.pgm", "P2 1 1 255 254");
  const std::string file = scratch.write(
      "m.yaml", map_yaml("m.pgm", "occupied_thresh: 0.65\nfree_thresh: 0.196\nmap_type: occupancy\n"));
  EXPECT_EQ(read_map(file).occupancy_percent, std::vector<std::int8_t>{0});
  ASSERT_EQ(map_notes(file).size(), 1u);
  EXPECT_EQ(map_notes(file)[0].rfind("map_type: ", 0), 0u);
}

TEST(MapFile, ScaleIsLinearBetweenThresholdsAndRawIsThePixel) {
  const ScratchDirectory scratch;
  scratch.write("m.pgm", "P2 4 1 100 100 75 50 0");
  const auto scale =
      scratch.write("s.yaml", map_yaml("m.pgm", "mode: scale\noccupied_thresh: 1.0\nfree_thresh: 0.0\n"));
  EXPECT_EQ(read_map(scale).occupancy_percent, (std::vector<std::int8_t>{0, 25, 50, 100}));
  scratch.write("r.pgm", "P2 4 1 255 0 42 100 200");
  const auto raw =
      scratch.write("r.yaml", map_yaml("r.pgm", "mode: raw\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"));
  EXPECT_EQ(read_map(raw).occupancy_percent, (std::vector<std::int8_t>{0, 42, 100, kUnknownCell}));
}

TEST(MapFile, BinaryAndTextPgmAgreeAtEightAndSixteenBits) {
  const ScratchDirectory scratch;
  scratch.write("a.pgm", "P2 2 1 255 0 254");
  scratch.write("b.pgm", std::string("P5 2 1 255\n\x00\xfe", 13));
  scratch.write("c.pgm", std::string("P5 2 1 65535\n\x00\x00\xfe\xfe", 17));
  for (const char* image : {"a.pgm", "b.pgm", "c.pgm"}) {
    const auto file = scratch.write("m.yaml", map_yaml(image, "occupied_thresh: 0.65\nfree_thresh: 0.25\n"));
    EXPECT_EQ(read_map(file).occupancy_percent, (std::vector<std::int8_t>{100, 0})) << image;
  }
}

TEST(MapFile, PngAveragesColorsAndScaleTakesSeeThroughAsUnknown) {
  const ScratchDirectory scratch;
  // 3 x 1 RGBA: black, white, see-through white.
  const unsigned char png[] = {
#include "tests/data/three_pixels.png.inc"
#include "tests/support/locations.hpp"
  };
  scratch.write("m.png", std::string(reinterpret_cast<const char*>(png), sizeof png));
  const auto trinary =
      scratch.write("t.yaml", map_yaml("m.png", "occupied_thresh: 0.65\nfree_thresh: 0.25\n"));
  EXPECT_EQ(read_map(trinary).occupancy_percent, (std::vector<std::int8_t>{100, 0, 0}));
  const auto scale =
      scratch.write("s.yaml", map_yaml("m.png", "mode: scale\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"));
  EXPECT_EQ(read_map(scale).occupancy_percent, (std::vector<std::int8_t>{100, 0, kUnknownCell}));
}

TEST(MapFile, ImagesOfOtherFormatsNameTheCommandThatConverts) {
  const ScratchDirectory scratch;
  for (const auto& [bytes, name] : {std::pair<std::string, std::string>{"BM....", "BMP"},
                                    {"\xFF\xD8\xFF\xE0", "JPEG"},
                                    {std::string("II*\0", 4), "TIFF"}}) {
    const std::string image = scratch.write("map.img", bytes);
    try {
      static_cast<void>(read_image(image, {}));
      ADD_FAILURE() << name;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().found, "a " + name + " image");
      EXPECT_NE(error.detail().hint.find("convert " + image), std::string::npos);
    }
  }
}

TEST(MapFile, TurnedOriginTurnsTheCells) {
  OccupancyGrid grid{.width = 4, .height = 2, .resolution_m = 1.0, .origin = {10, 5, M_PI / 2}};
  const auto cell = grid.cell_of(9.5, 7.5);  // 2.5 along the image's x axis, 0.5 along its y axis
  EXPECT_EQ(cell.column, 2);
  EXPECT_EQ(cell.row, 0);
  const auto center = grid.center_of(cell);
  EXPECT_NEAR(center[0], 9.5, 1e-12);
  EXPECT_NEAR(center[1], 7.5, 1e-12);
}

TEST(SpeedMask, PercentIsOfTheRobotsLimitAndZeroMeansNoCap) {
  SpeedMask mask{
      .grid = {.width = 3, .height = 1, .resolution_m = 1.0, .occupancy_percent = {0, 40, kUnknownCell}}};
  EXPECT_FALSE(mask.speed_cap_m_s(0.5, 0.5, 2.0));
  EXPECT_NEAR(*mask.speed_cap_m_s(1.5, 0.5, 2.0), 1.2, 1e-12);
  EXPECT_FALSE(mask.speed_cap_m_s(2.5, 0.5, 2.0));
  EXPECT_FALSE(mask.speed_cap_m_s(9.0, 0.5, 2.0));
}

}  // namespace
}  // namespace joulepath
