// Graphs of other programs, written by hand, against their places and ways.
#include <gtest/gtest.h>

#include "extensions/nav2/foreign_graphs.hpp"
#include "extensions/nav2/route_graph_export.hpp"
#include "extensions/nav2/route_graph_file.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kLif = R"({"metaInformation": {"lifVersion": "1.0.0"}, "layouts": [{"layoutId": "hall",
  "nodes": [{"nodeId": "dock", "nodePosition": {"x": 0, "y": 0}}, {"nodeId": "shelf", "nodePosition": {"x": 3, "y": 4}}],
  "edges": [{"edgeId": "e", "startNodeId": "dock", "endNodeId": "shelf",
    "vehicleTypeEdgeProperties": [{"vehicleTypeId": "a", "maxSpeed": 0.8}, {"vehicleTypeId": "b", "maxSpeed": 0.5}]}]}]})";

const std::string kBuilding = R"(name: hall
coordinate_system: reference_image
levels:
  L1:
    vertices:
      - [100, 200, 0, dock, {}]
      - [300, 200, 0, shelf, {is_parking_spot: [4, true]}]
      - [300, 400, 0, ""]
    measurements:
      - [0, 1, {distance: [3, 10]}]
    lanes:
      - [0, 1, {bidirectional: [4, true], graph_idx: [2, 0]}]
      - [1, 2, {bidirectional: [4, false], graph_idx: [2, 0], speed_limit: [3, 0.4]}]
)";

const std::string kNavigation = R"(building_name: hall
levels:
  L1:
    lanes:
      - [0, 1, {is_bidirectional: false, speed_limit: 0.3}]
    vertices:
      - [1.5, -2, {name: dock}]
      - [4.5, 2, {name: ""}]
)";

std::string refusal(const std::string& file) {
  try {
    static_cast<void>(read_route_graph(file));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& old, const std::string& part) {
  return text.replace(text.find(old), old.size(), part);
}

TEST(ForeignGraph, LifLayoutsHaveTheirNodesAndTheLeastSpeed) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("hall.json", kLif);
  const RouteGraph graph = read_route_graph(file);
  ASSERT_EQ(graph.nodes.size(), 2u);
  EXPECT_EQ(graph.nodes[1].x_m, 3);
  EXPECT_EQ(graph.nodes[1].y_m, 4);
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(graph.edges[0].speed_limit_m_s, 0.5);
  EXPECT_EQ(read_any_file(file).kind, "route graph");
}

TEST(ForeignGraph, BuildingsAreScaledByTheirMeasurementsAndTurnedUpward) {
  const ScratchDirectory scratch;
  const RouteGraph graph = read_route_graph(scratch.write("hall.building.yaml", kBuilding));
  ASSERT_EQ(graph.nodes.size(), 3u);
  // 200 pixels are 10 m; an image's y runs downward.
  EXPECT_NEAR(graph.nodes[0].x_m, 5, 1e-9);
  EXPECT_NEAR(graph.nodes[0].y_m, -10, 1e-9);
  EXPECT_NEAR(graph.nodes[2].y_m, -20, 1e-9);
  ASSERT_EQ(graph.edges.size(), 3u);  // two directions of the first lane, one of the second
  EXPECT_EQ(graph.edges[2].speed_limit_m_s, 0.4);
}

TEST(ForeignGraph, NavigationGraphsAreInMeters) {
  const ScratchDirectory scratch;
  const RouteGraph graph = read_route_graph(scratch.write("0.yaml", kNavigation));
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(graph.nodes[0].y_m, -2);
  EXPECT_EQ(graph.edges[0].speed_limit_m_s, 0.3);
}

TEST(ForeignGraph, WhatIsNoPlaceOnAMapIsRefused) {
  const ScratchDirectory scratch;
  EXPECT_NE(refusal(scratch.write("a.yaml", with(kBuilding, "reference_image", "wgs84")))
                .find("degrees are no metres"),
            std::string::npos);
  EXPECT_NE(refusal(scratch.write("b.yaml", with(kBuilding, "      - [0, 1, {distance: [3, 10]}]\n", "")))
                .find("no measurements"),
            std::string::npos);
  EXPECT_NE(refusal(scratch.write("c.yaml", with(kBuilding, "{bidirectional: [4, false], graph_idx: [2, 0]",
                                                 "{graph_idx: [2, 1]")))
                .find("lanes of the graphs 0, 1"),
            std::string::npos);
  const std::string floors = with(
      kNavigation, "levels:\n", "levels:\n  L2: {lanes: [[0, 1, {}]], vertices: [[0, 0, {}], [1, 0, {}]]}\n");
  EXPECT_NE(refusal(scratch.write("d.yaml", floors)).find("2 levels with lanes: L2, L1"), std::string::npos);
  EXPECT_NE(
      refusal(scratch.write("g.yaml",
                            with(kBuilding, "[300, 200, 0, shelf, {is_parking_spot: [4, true]}]", "[5]")))
          .find("[x, y, ...]"),
      std::string::npos);
  // A lane without a graph_idx is of graph 0.
  EXPECT_NE(
      refusal(scratch.write("h.yaml", with(with(kBuilding, "[4, true], graph_idx: [2, 0]", "[4, true]"),
                                           "[4, false], graph_idx: [2, 0]", "[4, false], graph_idx: [2, 1]")))
          .find("lanes of the graphs 0, 1"),
      std::string::npos);
  EXPECT_NE(refusal(scratch.write("i.yaml", with(kNavigation, "speed_limit: 0.3", "speed_limit: 300")))
                .find("i.yaml:5:"),
            std::string::npos);
  const std::string point =
      R"({"type": "FeatureCollection", CRS"features": [{"type": "Feature", "properties": {"id": 0FRAME},
    "geometry": {"type": "Point", "coordinates": [11.5, 48.1]}}]})";
  EXPECT_NE(
      refusal(scratch.write("e.geojson", with(with(point, "CRS", ""), "FRAME", ", \"frame\": \"wgs84\"")))
          .find("degrees are no metres"),
      std::string::npos);
  const std::string crs =
      R"("crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}, )";
  EXPECT_NE(refusal(scratch.write("f.geojson", with(with(point, "CRS", crs), "FRAME", "")))
                .find("degrees are no metres"),
            std::string::npos);
}

TEST(ForeignGraph, ExportAddsEnergiesToAGraphOfAnotherProgram) {
  const ScratchDirectory scratch;
  const Robot robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  const RouteGraphExport result = export_route_graph(
      {.graph_file = scratch.write("hall.building.yaml", kBuilding), .out_file = scratch.at("out.geojson")},
      robot);
  const std::string energies = scratch.write("out.geojson", result.files.front().content);
  EXPECT_NE(result.files.front().content.find("energy_J"), std::string::npos);
  EXPECT_NE(result.files.front().content.find("\"name\": \"shelf\""), std::string::npos);
  EXPECT_EQ(read_route_graph(energies).edges.size(), 3u);
}

}  // namespace
}  // namespace joulepath
