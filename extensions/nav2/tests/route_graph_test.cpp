#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <queue>
#include <set>

#include "extensions/nav2/route_graph_export.hpp"
#include "extensions/nav2/route_graph_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

std::string point(long id, double x, double y) {
  return R"({"type": "Feature", "properties": {"id": )" + std::to_string(id) +
         R"(}, "geometry": {"type": "Point", "coordinates": [)" + std::to_string(x) + ", " +
         std::to_string(y) + "]}}";
}
std::string line(long id, long from, long to, const std::string& metadata = "{}") {
  return R"({"type": "Feature", "properties": {"id": )" + std::to_string(id) + R"(, "startid": )" +
         std::to_string(from) + R"(, "endid": )" + std::to_string(to) + R"(, "metadata": )" + metadata +
         R"(}, "geometry": {"type": "LineString", "coordinates": []}})";
}
std::string collection(const std::vector<std::string>& features) {
  std::string text = R"({"type": "FeatureCollection", "features": [)";
  for (std::size_t i = 0; i < features.size(); ++i) text += (i ? ",\n" : "") + features[i];
  return text + "]}";
}

/// Route servers read no geometry of edges.
TEST(RouteGraphFile, EdgesWithoutGeometryAreStraight) {
  const ScratchDirectory scratch;
  for (const char* geometry : {R"("geometry": null)", R"("geometry": {"type": "MultiLineString"})",
                               R"("geometry": {"type": "LineString", "coordinates": []})",
                               R"("geometry": {"type": "LineString", "coordinates": [[[0, 0], [4, 0]]]})",
                               R"("bbox": [0, 0, 1, 1])"}) {
    const RouteGraph graph = read_route_graph(scratch.write(
        "g.geojson",
        collection(
            {std::string(R"({"type": "Feature", "properties": {"id": 9, "startid": 1, "endid": 2}, )") +
                 geometry + "}",
             point(1, 0, 0), point(2, 4, 0)})));
    ASSERT_EQ(graph.edges.size(), 1u) << geometry;
    EXPECT_TRUE(graph.edges[0].via_m.empty());
    EXPECT_EQ(graph.nodes[graph.edges[0].end].x_m, 4);
  }
  EXPECT_THROW((void)read_route_graph(scratch.write(
                   "g.geojson", collection({R"({"type": "Feature", "properties": {"id": 1}})"}))),
               ConfigError);
}

/// A square of 4 m, once round, and a straight edge of 8 m out of it.
std::string square() {
  return collection({point(1, 0, 0), point(2, 4, 0), point(3, 4, 4), point(4, 0, 4), point(5, 12, 0),
                     line(10, 1, 2), line(11, 2, 3), line(12, 3, 4), line(13, 4, 1), line(14, 2, 5)});
}

std::map<long, Json> metadata_of(const std::string& text) {
  std::map<long, Json> metadata;
  const Json json = Json::parse(text);
  for (const Json& feature : json["features"])
    if (feature["geometry"]["type"] == "LineString")
      metadata[feature["properties"]["id"]] = feature["properties"]["metadata"];
  return metadata;
}

TEST(RouteGraph, EveryNumberOfAnEdgeIsAPositiveFloat) {
  const ScratchDirectory directory;
  const std::string file = directory.write("graph.geojson", square());
  for (const bool expand : {false, true}) {
    const RouteGraphExport result =
        export_route_graph({file, directory.at("out.geojson"), 5.0, 0.0, expand}, testing::nomad());
    for (const auto& [id, metadata] : metadata_of(result.files[0].content))
      for (const char* key : {"energy_J", "abs_time_taken", "abs_speed_limit", "speed_limit"}) {
        EXPECT_TRUE(metadata.at(key).is_number_float()) << id << ' ' << key;
        EXPECT_NE(metadata.at(key).dump().find('.'), std::string::npos) << metadata.at(key);
        EXPECT_GT(metadata.at(key).get<double>(), 0);
      }
  }
}

TEST(RouteGraph, KeepsWhatTheGraphSaysAndASpeedLimit) {
  const ScratchDirectory directory;
  const std::string file = directory.write(
      "graph.geojson", collection({point(1, 0, 0), point(2, 8, 0),
                                   line(10, 1, 2, R"({"abs_speed_limit": 0.3, "class": "aisle"})")}));
  const RouteGraphExport result =
      export_route_graph({file, directory.at("out.geojson"), 0, 0, false}, testing::nomad());
  const Json edge = metadata_of(result.files[0].content).at(10);
  EXPECT_EQ(edge["class"], "aisle");
  EXPECT_NEAR(edge["abs_speed_limit"].get<double>(), 0.3, 1e-6);
  EXPECT_NEAR(edge["abs_time_taken"].get<double>(), 8 / 0.3, 1e-3);
  EXPECT_NEAR(edge["speed_limit"].get<double>(), 30.0, 1e-3);
}

/// The percentage that a route server's AdjustSpeedLimit reads holds as the limit in m/s does, as an integer,
/// too.
TEST(RouteGraph, KeepsASpeedLimitInPercent) {
  const ScratchDirectory directory;
  const double most_m_s = testing::nomad().limits->speed_m_s;
  for (const char* percent : {"30.0", "30"}) {
    const std::string file = directory.write(
        "graph.geojson", collection({point(1, 0, 0), point(2, 8, 0),
                                     line(10, 1, 2, std::string(R"({"speed_limit": )") + percent + "}")}));
    const RouteGraphExport result =
        export_route_graph({file, directory.at("out.geojson"), 0, 0, false}, testing::nomad());
    const Json edge = metadata_of(result.files[0].content).at(10);
    EXPECT_LE(edge["speed_limit"].get<double>(), 30.0 + 1e-6);
    EXPECT_LE(edge["abs_speed_limit"].get<double>(), 0.3 * most_m_s + 1e-6);
  }
}

/// Friction and standby per meter, by the closed form of constant speed: (R i^2 + Kt n i w) for both motors.
TEST(RouteGraph, AStraightEdgeCostsItsSteadyPower) {
  const ScratchDirectory directory;
  const std::string file =
      directory.write("graph.geojson", collection({point(1, 0, 0), point(2, 8, 0), line(10, 1, 2)}));
  const Robot robot = testing::nomad();
  const RouteGraphExport result = export_route_graph({file, directory.at("o.geojson"), 0, 0, false}, robot);
  const Json edge = metadata_of(result.files[0].content).at(10);
  const double v = edge["abs_speed_limit"].get<double>(), w = v / 0.1;
  double power_W = robot.power.standby_W;
  for (const Side side : kSides) {
    const Motor& motor = robot.motor[side];
    const double kt = motor.torque_per_ampere_Nm_A();
    const double i = (motor.friction_torque_Nm + motor.viscous_friction_Nm_s_rad * w) / kt;
    power_W += motor.resistance_ohm * i * i + motor.volts_per_speed_V_s_rad() * w * i;
  }
  EXPECT_NEAR(edge["energy_J"].get<double>(), power_W * 8 / v, 1e-4 * power_W * 8 / v);
}

/// Around a ring each corner belongs to one pair of edges: attribution leaves nothing over there.
TEST(RouteGraph, CornersOfAPathAreAttributedExactly) {
  const ScratchDirectory directory;
  const std::string file = directory.write(
      "graph.geojson", collection({point(1, 0, 0), point(2, 4, 0), point(3, 4, 4), point(4, 0, 4),
                                   line(10, 1, 2), line(11, 2, 3), line(12, 3, 4), line(13, 4, 1)}));
  const GraphCosts costs = graph_costs(read_route_graph(file), testing::nomad(), 5, 0);
  EXPECT_EQ(costs.corners.size(), 4u);
  EXPECT_LT(costs.attribution.worst_J, 1e-6);
  double apart = 0, together = 0;
  for (const EdgeCost& cost : costs.edges) apart += cost.energy_J;
  for (const CornerCost& corner : costs.corners) apart += corner.energy_J;
  for (const EdgeCost& cost : costs.with_turns) together += cost.energy_J;
  EXPECT_NEAR(apart, together, 1e-6 * apart);
  for (const CornerCost& corner : costs.corners) EXPECT_GT(corner.energy_J, 5);
}

TEST(RouteGraph, MoreOnBoardCostsMoreOnEveryCorner) {
  const ScratchDirectory directory;
  const RouteGraph graph = read_route_graph(directory.write("graph.geojson", square()));
  const GraphCosts empty = graph_costs(graph, testing::nomad(), 0, 0);
  const GraphCosts loaded = graph_costs(graph, testing::nomad(), 10, 0);
  for (std::size_t i = 0; i < empty.corners.size(); ++i)
    EXPECT_GE(loaded.corners[i].energy_J, empty.corners[i].energy_J);
}

/// The expanded graph's cheapest route from node 1 to node 5 costs two edges and a straight joint; to node 3
/// it costs two edges and a corner.
TEST(RouteGraph, ExpandedCostsOfRoutesAreExact) {
  const ScratchDirectory directory;
  const std::string file = directory.write("graph.geojson", square());
  const GraphCosts costs = graph_costs(read_route_graph(file), testing::nomad(), 5, 0);
  const RouteGraphExport result =
      export_route_graph({file, directory.at("o.geojson"), 5, 0, true}, testing::nomad());
  const Json json = Json::parse(result.files[0].content);
  std::map<long, std::vector<std::pair<long, double>>> leaving;
  std::map<long, long> goal;
  for (const Json& feature : json["features"]) {
    const Json& p = feature["properties"];
    if (p.contains("startid"))
      leaving[p["startid"]].push_back({p["endid"], p["metadata"]["energy_J"]});
    else if (p.contains("metadata") && p["metadata"].contains("goal_of"))
      goal[p["metadata"]["goal_of"]] = p["id"];
  }
  const auto cheapest = [&](long from, long to) {
    std::map<long, double> cost{{from, 0.0}};
    std::priority_queue<std::pair<double, long>, std::vector<std::pair<double, long>>, std::greater<>> open;
    open.emplace(0.0, from);
    while (!open.empty()) {
      const auto [c, node] = open.top();
      open.pop();
      for (const auto& [next, step] : leaving[node])
        if (!cost.contains(next) || c + step < cost[next]) open.emplace(cost[next] = c + step, next);
    }
    return cost.at(to);
  };
  const auto corner_J = [&](std::size_t in, std::size_t out) {
    for (const CornerCost& corner : costs.corners)
      if (corner.in == in && corner.out == out) return corner.energy_J;
    return std::nan("");
  };
  const auto& e = costs.edges;
  EXPECT_NEAR(corner_J(0, 4), 0, 1e-9);
  EXPECT_NEAR(cheapest(1, goal.at(5)), e[0].energy_J + e[4].energy_J, 1e-5);
  EXPECT_NEAR(cheapest(1, goal.at(3)), e[0].energy_J + corner_J(0, 1) + e[1].energy_J, 1e-5);
  for (const auto& [node, id] : goal) EXPECT_EQ(id, node + result.goal_offset);
  EXPECT_EQ(result.goal_offset, 10);
}

/// The server's dense path ends with the direction of its last edge, and its tracker goes by the directions
/// of edges: none may have length 0. What a node carries holds at its copies, too.
TEST(RouteGraph, ExpandedNodesAndEdgesKeepWhatARouteServerNeeds) {
  const ScratchDirectory directory;
  std::string graph = square();
  const std::string plain = R"({"id": 2})";
  graph.replace(
      graph.find(plain), plain.size(),
      R"({"id": 2, "frame": "floor", "operations": {"door": {"type": "TriggerEvent", "trigger": "NODE"}}})");
  const std::string file = directory.write("graph.geojson", graph);
  const RouteGraphExport result =
      export_route_graph({file, directory.at("o.geojson"), 5, 0, true}, testing::nomad());
  std::map<long, Json> nodes;
  int copies = 0;  // of node 2
  const Json json = Json::parse(result.files[0].content);
  for (const Json& feature : json["features"]) {
    const Json& p = feature["properties"];
    if (feature["geometry"]["type"] == "Point") {
      nodes[p["id"]] = feature["geometry"]["coordinates"];
      if (feature["geometry"]["coordinates"] == Json({4.0, 0.0})) {
        EXPECT_EQ(p.value("frame", ""), "floor") << p;
        EXPECT_TRUE(p.contains("operations")) << p;
        ++copies;
      }
    } else {
      EXPECT_NE(nodes.at(p["startid"]), nodes.at(p["endid"])) << p;
    }
  }
  EXPECT_EQ(copies, 3);  // itself, its goal, its one arrival
  EXPECT_NE(result.files[1].content.find("nav2_route::TriggerEvent"), std::string::npos);
  EXPECT_TRUE(result.warnings.empty());
}

/// Nodes that routes from a node reach.
std::set<long> reached(const std::map<long, std::vector<long>>& leaving, long from) {
  std::set<long> seen{from};
  std::vector<long> open{from};
  while (!open.empty()) {
    const long node = open.back();
    open.pop_back();
    if (const auto next = leaving.find(node); next != leaving.end())
      for (const long id : next->second)
        if (seen.insert(id).second) open.push_back(id);
  }
  return seen;
}

TEST(RouteGraph, AnExpandedGraphReachesWhatTheGraphReaches) {
  const ScratchDirectory directory;
  for (const char* name : {"warehouse_graph", "depot_graph"}) {
    const std::string file = std::string(JOULEPATH_SOURCE_DIR "/scenarios/maps/") + name + ".geojson";
    const RouteGraph graph = read_route_graph(file);
    const RouteGraphExport result =
        export_route_graph({file, directory.at("o.geojson"), 0, 0, true}, testing::nomad());
    std::map<long, std::vector<long>> plain, expanded;
    for (const RouteGraph::Edge& edge : graph.edges)
      plain[graph.nodes[edge.start].id].push_back(graph.nodes[edge.end].id);
    const Json json = Json::parse(result.files[0].content);
    for (const Json& feature : json["features"])
      if (const Json& p = feature["properties"]; p.contains("startid"))
        expanded[p["startid"]].push_back(p["endid"]);
    for (const RouteGraph::Node& from : graph.nodes) {
      const std::set<long> goals = reached(expanded, from.id);
      for (const long id : reached(plain, from.id))
        EXPECT_TRUE(id == from.id || goals.contains(id + result.goal_offset)) << from.id << " to " << id;
    }
  }
}

/// A route server does not read the lines of edges: robots drive straight from node to node.
TEST(RouteGraph, EdgesAreStraightAsTheServerDrivesThem) {
  const ScratchDirectory directory;
  const auto exported = [&](const std::string& coordinates) {
    std::string edge = line(10, 1, 2);
    edge.replace(edge.find(R"("coordinates": [])"), 17, R"("coordinates": )" + coordinates);
    return export_route_graph(
        {directory.write("graph.geojson", collection({point(1, 0, 0), point(2, 8, 0), edge})),
         directory.at("o"), 0, 0, false},
        testing::nomad());
  };
  const RouteGraphExport straight = exported("[]"), bent = exported("[[0, 0], [4, 3], [8, 0]]");
  EXPECT_EQ(metadata_of(straight.files[0].content).at(10), metadata_of(bent.files[0].content).at(10));
  EXPECT_TRUE(straight.warnings.empty());
  ASSERT_EQ(bent.warnings.size(), 1u);
  EXPECT_NE(bent.warnings[0].find("10"), std::string::npos);
}

TEST(RouteGraph, WarnsOfWhatTheServerWouldNotDo) {
  const ScratchDirectory directory;
  std::string edge = line(10, 1, 2);
  edge.insert(
      edge.find(R"("startid")"),
      R"("overridable": false, "cost": 3.0, "operations": {"o": {"type": "open_door", "trigger": "ON_EXIT"}}, )");
  const std::string file =
      directory.write("graph.geojson", collection({point(1, 0, 0), point(2, 8, 0), edge}));
  const RouteGraphExport result =
      export_route_graph({file, directory.at("o.geojson"), 0, 0, false}, testing::nomad());
  ASSERT_EQ(result.warnings.size(), 2u);
  EXPECT_NE(result.warnings[0].find("open_door"), std::string::npos);
  EXPECT_NE(result.files[1].content.find("open_door"), std::string::npos);
  EXPECT_NE(result.warnings[1].find("overridable"), std::string::npos);
  EXPECT_NE(result.warnings[1].find("10"), std::string::npos);
}

TEST(RouteGraph, TheSettingsNameTheGraphAndTheTag) {
  const ScratchDirectory directory;
  const std::string file = directory.write("graph.geojson", square());
  const RouteGraphExport result =
      export_route_graph({file, directory.at("energy.geojson"), 0, 0, false}, testing::nomad());
  ASSERT_EQ(result.files.size(), 2u);
  EXPECT_EQ(result.files[1].name, directory.at("energy.route_server.yaml"));  // one for each payload band
  const std::string& text = result.files[1].content;
  EXPECT_NE(text.find("penalty_tag: energy_J"), std::string::npos);
  // The server opens the path as it is, from its own working directory.
  EXPECT_NE(
      text.find("graph_filepath: \"" + std::filesystem::absolute(directory.at("energy.geojson")).string()),
      std::string::npos);
  EXPECT_NE(text.find("operations: [\"AdjustSpeedLimit\", \"ReroutingService\"]"), std::string::npos);
  EXPECT_NE(text.find("plugin: \"nav2_route::ReroutingService\""), std::string::npos);
}

/// A star with a slip road: corners of very different costs meet in one node, which a fit by least squares
/// without bounds pays with negative shares.
std::string star() {
  return collection({point(1, 0, 0), point(2, 4, 0), point(3, 4, 4), point(4, 4, -4), point(5, 8, 0.1),
                     point(6, 4.2, 0.3), line(10, 1, 2), line(11, 2, 3), line(12, 2, 4), line(13, 2, 5),
                     line(14, 2, 6), line(15, 3, 2), line(16, 4, 2), line(17, 5, 2), line(18, 6, 2),
                     line(19, 6, 5)});
}

TEST(RouteGraph, NoEdgeIsCheaperThanItsStraightDrive) {
  const ScratchDirectory directory;
  const RouteGraph graph = read_route_graph(directory.write("graph.geojson", star()));
  const GraphCosts costs = graph_costs(graph, testing::nomad(), 5, 0);
  double worst_J = 0;
  for (const CornerCost& corner : costs.corners) EXPECT_GE(corner.energy_J, 0);
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    EXPECT_GE(costs.with_turns[e].energy_J, costs.edges[e].energy_J) << graph.edges[e].id;
    EXPECT_GE(costs.with_turns[e].time_s, costs.edges[e].time_s) << graph.edges[e].id;
  }
  for (const CornerCost& corner : costs.corners) worst_J = std::max(worst_J, corner.energy_J);
  EXPECT_LE(costs.attribution.worst_J, worst_J);
  EXPECT_GT(costs.attribution.rms_J, 0);
}

TEST(RouteGraph, ArcsThatAreTooLongAreTheLargestThatFit) {
  const ScratchDirectory directory;
  const RouteGraph graph = read_route_graph(directory.write("graph.geojson", square()));
  const GraphCosts fits = graph_costs(graph, testing::nomad(), 5, 0.5);
  const GraphCosts too_long = graph_costs(graph, testing::nomad(), 5, 30);
  const GraphCosts turns = graph_costs(graph, testing::nomad(), 5, 0);
  EXPECT_GT(fits.fits_up_to_rad, 1.6);
  EXPECT_LT(too_long.fits_up_to_rad, 1.5);
  for (std::size_t i = 0; i < turns.corners.size(); ++i) {
    if (turns.corners[i].energy_J < 1) continue;
    EXPECT_LT(too_long.corners[i].energy_J, fits.corners[i].energy_J) << "longer arcs are cheaper";
    EXPECT_LT(fits.corners[i].energy_J, turns.corners[i].energy_J);
  }
  const std::string file = directory.write("graph.geojson", square());
  const auto exported = [&](double radius_m) {
    return export_route_graph({file, directory.at("o"), 0, radius_m, false}, testing::nomad());
  };
  EXPECT_EQ(exported(0.3).arcs, "");
  EXPECT_NE(exported(30).arcs, "");
  EXPECT_THROW((void)exported(1e-9), ConfigError);
}

TEST(RouteGraph, AbsurdLimitsAndDoubleIdsAreRefused) {
  const ScratchDirectory directory;
  const auto refusal = [&](const std::string& edges) -> std::string {
    try {
      (void)read_route_graph(
          directory.write("graph.geojson", R"({"type": "FeatureCollection", "features": [)" + point(1, 0, 0) +
                                               "," + point(2, 8, 0) + "," + edges + "]}"));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(line(10, 1, 2, R"({"abs_speed_limit": 0.5})")), "");
  for (const char* limit : {"-1", "0", "1e-9", "1e9"}) {
    const std::string text = refusal(line(10, 1, 2, std::string(R"({"abs_speed_limit": )") + limit + "}"));
    EXPECT_NE(text.find("abs_speed_limit"), std::string::npos) << limit;
  }
  for (const char* limit : {"0", "101", "\"slow\""}) {
    const std::string text = refusal(line(10, 1, 2, std::string(R"({"speed_limit": )") + limit + "}"));
    EXPECT_NE(text.find("speed_limit"), std::string::npos) << limit;
  }
  EXPECT_NE(refusal(point(2, 9, 0)).find("id"), std::string::npos);
  EXPECT_EQ(refusal(line(10, 1, 2) + "," + line(10, 2, 1)), "");  // as in Nav2's own graph of its depot
}

TEST(RouteGraph, TheGraphsOfNav2AreRead) {
  for (const char* name : {"warehouse_graph", "depot_graph"})
    EXPECT_FALSE(read_route_graph(std::string(JOULEPATH_SOURCE_DIR "/scenarios/maps/") + name + ".geojson")
                     .edges.empty())
        << name;
}

TEST(RouteGraph, AFileOfAnotherKindIsNamed) {
  const ScratchDirectory directory;
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      (void)read_route_graph(directory.write("file.yaml", text));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("schema: joulepath/mission/1\nlegs: []\n").find("a file of kind mission"),
            std::string::npos);
  EXPECT_NE(refusal("image: map.pgm\n").find("a file of kind map"), std::string::npos);
  EXPECT_NE(refusal("a: 1\n").find("route graph"), std::string::npos);
  const auto refusal_of_mission = [&](const std::string& name, const std::string& text) -> std::string {
    try {
      (void)read_mission(directory.write(name, text));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal_of_mission("graph.geojson", square()).find("a file of kind route graph"),
            std::string::npos);
  EXPECT_NE(refusal_of_mission("mission.yaml",
                               "robot: robot.yaml\nmap: dock\nstations: {dock: {x_m: 1, y_m: 2}}\n"
                               "legs: [{to: dock}]\n")
                .find("map: found the station dock"),
            std::string::npos);
}

TEST(RouteGraph, AGraphWithoutEdgesIsRefused) {
  const ScratchDirectory directory;
  const std::string file = directory.write("graph.geojson", collection({point(1, 0, 0)}));
  EXPECT_THROW((void)export_route_graph({file, directory.at("o"), 0, 0, false}, testing::nomad()),
               ConfigError);
}

}  // namespace
}  // namespace joulepath
