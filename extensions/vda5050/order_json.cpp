#include "extensions/vda5050/order_json.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "planner/path/geometry/quintic_fit.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTolerance_m = 1e-3;

/// A curve's piece as a NURBS of degree 5: its Bezier curves with knots of full multiplicity between them.
Json trajectory_json(const std::vector<RationalBezier>& pieces) {
  constexpr std::size_t kDegree = 5;
  Json knots = Json::array(), points = Json::array();
  const auto knot = [&](std::size_t piece, std::size_t times) {
    const double value = static_cast<double>(piece) / static_cast<double>(pieces.size());
    for (std::size_t i = 0; i < times; ++i) knots.push_back(value);
  };
  knot(0, kDegree + 1);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (std::size_t i = k == 0 ? 0 : 1; i <= kDegree; ++i) {
      const auto place = pieces[k].place_m(i);
      points.push_back({{"x", place[0]}, {"y", place[1]}, {"weight", 1.0}});
    }
    knot(k + 1, k + 1 == pieces.size() ? kDegree + 1 : kDegree);
  }
  return {{"degree", kDegree}, {"knotVector", std::move(knots)}, {"controlPoints", std::move(points)}};
}

bool straight(const Curve& curve, double from_m, double to_m) {
  const double middle_m = 0.5 * (from_m + to_m);
  return std::max({std::abs(curve.at(from_m + 1e-9).curvature_per_m),
                   std::abs(curve.at(middle_m).curvature_per_m),
                   std::abs(curve.at(to_m - 1e-9).curvature_per_m)}) < 1e-9;
}

/// Writes nodes and edges alternately; sequence ids count both.
class OrderWriter {
 public:
  explicit OrderWriter(std::string map_id) : map_id_(std::move(map_id)) {}

  void node(const std::string& id, const Pose& pose) {
    nodes_.push_back({{"nodeId", id},
                      {"sequenceId", 2 * nodes_.size()},
                      {"released", true},
                      {"nodePosition", {{"x", pose.x_m}, {"y", pose.y_m}, {"mapId", map_id_}}},
                      {"actions", Json::array()}});
  }

  void edge(const Curve& curve, double from_m, double to_m, double speed_m_s) {
    Json json{{"edgeId", "edge_" + std::to_string(edges_.size())},
              {"sequenceId", 2 * edges_.size() + 1},
              {"released", true},
              {"maximumSpeed", speed_m_s},
              {"length", to_m - from_m}};
    if (curve.direction() == Direction::reverse) json["orientation"] = std::numbers::pi;
    if (!straight(curve, from_m, to_m))
      json["trajectory"] = trajectory_json(quintic_fit(curve, from_m, to_m, kTolerance_m));
    json["actions"] = Json::array();
    edges_.push_back(std::move(json));
    node("node_" + std::to_string(nodes_.size()), curve.at(to_m).pose);
  }

  Json& last_node() { return nodes_.back(); }

  void face(double heading_rad) { last_node()["nodePosition"]["theta"] = wrapped_angle_rad(heading_rad); }

  void wait(double duration_s) {
    last_node()["actions"].push_back({{"actionType", "wait"},
                                      {"actionId", "wait_" + std::to_string(nodes_.size())},
                                      {"blockingType", "HARD"},
                                      {"actionParameters", {{{"key", "duration"}, {"value", duration_s}}}}});
  }

  Json order(const std::string& id) const {
    return {{"headerId", 0},      {"timestamp", "1970-01-01T00:00:00.000Z"},
            {"version", "3.0.0"}, {"manufacturer", ""},
            {"serialNumber", ""}, {"orderId", id},
            {"orderUpdateId", 0}, {"nodes", nodes_},
            {"edges", edges_}};
  }

 private:
  std::string map_id_{};
  Json nodes_ = Json::array();
  Json edges_ = Json::array();
};

void write_leg(OrderWriter& writer, const LegPlan& leg, const std::vector<double>& speeds_m_s) {
  std::size_t part = 0;
  bool turned = false;
  for (const StretchPlan& stretch : leg.stretches) {
    if ((turned = is_turn(stretch.request.piece))) continue;
    const Curve& curve = std::get<Curve>(stretch.request.piece);
    const std::vector<double>& breaks_m = curve.breakpoints_m();
    for (std::size_t k = 0; k + 1 < breaks_m.size(); ++k)
      writer.edge(curve, breaks_m[k], breaks_m[k + 1], speeds_m_s[part++]);
  }
  const PathPiece* last = leg.stretches.empty() ? nullptr : &leg.stretches.back().request.piece;
  if (last && !leg.to.empty() && leg.to != "path") writer.last_node()["nodeId"] = leg.to;
  if (last && turned) writer.face(piece_point(*last, piece_length(*last)).pose.heading_rad);
}

/// A robot passes a node without an action at speed: where the plan stops on its way, it waits for its dwell,
/// which may be no time at all.
bool waits_after(const LegPlan& leg, bool last) {
  const bool rests = leg.stretches.empty() || leg.stretches.back().request.end_rate == 0;
  return leg.dwell_s > 0 || (!last && rests);
}

}  // namespace

Json order_with_speeds(const ExportInput& input, const PartSpeeds& speeds) {
  Json order = Json::parse(read_text_file(input.mission.order_file));
  const bool version_3 = order["version"].get<std::string>().rfind("3.", 0) == 0;
  const char* key = version_3 ? "maximumSpeed" : "maxSpeed";
  std::vector<Json*> edges;
  for (Json& edge : order["edges"]) edges.push_back(&edge);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Json* a, const Json* b) { return (*a)["sequenceId"] < (*b)["sequenceId"]; });
  std::size_t edge = 0;
  for (std::size_t leg = 0; leg < input.plan.legs.size(); ++leg)
    for (std::size_t part = 0; part < input.plan.legs[leg].parts.size(); ++part, ++edge)
      if (const double speed_m_s = speeds[leg][part]; speed_m_s > 0) {
        Json& json = *edges[edge];
        json[key] = json.contains(key) ? std::min(json[key].get<double>(), speed_m_s) : speed_m_s;
      }
  return order;
}

Json order_of_plan(const ExportInput& input, const PartSpeeds& speeds) {
  const std::string map = std::filesystem::path(input.mission.map_file).stem().string();
  OrderWriter writer(map.empty() ? "map" : map);
  bool begun = false;
  for (std::size_t k = 0; k < input.plan.legs.size(); ++k) {
    const LegPlan& leg = input.plan.legs[k];
    if (leg.prescribed)
      throw ConfigError({input.mission.marks.at("legs"), "legs[" + std::to_string(k) + "].motion",
                         "a prescribed motion", "legs with to: or path:", "an order has paths, not motions"});
    if (!begun) {
      writer.node(input.mission.start.station.empty() ? "start" : input.mission.start.station,
                  leg.start_pose);
      writer.face(leg.start_pose.heading_rad);
      begun = true;
    }
    write_leg(writer, leg, speeds[k]);
    if (waits_after(leg, k + 1 == input.plan.legs.size())) writer.wait(leg.dwell_s);
  }
  return writer.order(input.plan.mission);
}

}  // namespace joulepath
