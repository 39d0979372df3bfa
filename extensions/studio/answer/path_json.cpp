#include "extensions/studio/answer/path_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "model/config_error.hpp"
#include "planner/path/shape/bezier_chain.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& found, const std::string& accepted) {
  throw ConfigError({{}, "paths", found, accepted, ""});
}

json segment_json(const LinearCurvature& segment) {
  const PathPoint from = segment.at(0);
  return {{"arc",
           {from.pose.x_m, from.pose.y_m, from.pose.heading_rad, segment.length_m(), from.curvature_per_m,
            from.curvature_slope_per_m2}}};
}

json segment_json(const BezierSegment& segment) {
  if (segment.rational()) return {{"rational", segment.rational()->points}};
  return {{"bezier", segment.points_m()}};
}

json segment_json(const DirectionSegment& segment) {
  const Pose& from = segment.start();
  const auto& [from_rad, to_rad, length_m, half_track_m] = segment.shape();
  return {{"direction", {from.x_m, from.y_m, from.heading_rad, from_rad, to_rad, length_m, half_track_m}}};
}

json piece_json(const TurnInPlace& turn) {
  return {{"turn", {turn.start.x_m, turn.start.y_m, turn.start.heading_rad, turn.angle_rad}}};
}

json piece_json(const Curve& curve) {
  json segments = json::array();
  for (const CurveSegment& segment : curve.segments())
    segments.push_back(std::visit([](const auto& one) { return segment_json(one); }, segment));
  return {{"reverse", curve.direction() == Direction::reverse}, {"segments", std::move(segments)}};
}

CurveSegment arc_from(const std::array<double, 6>& arc) {
  if (!(arc[3] > 0)) refuse("an arc without a length", "a length above 0");
  return LinearCurvature({arc[0], arc[1], arc[2]}, arc[3], arc[4], arc[5]);
}

CurveSegment direction_from(const std::array<double, 7>& d) {
  const bool forward = std::cos(d[3]) > 0 && std::cos(d[4]) > 0;
  if (!forward || !(d[5] > 0) || !(d[6] > 0))
    refuse("a direction segment that does not drive forward",
           "directions within a quarter turn, lengths above 0");
  return DirectionSegment({d[0], d[1], d[2]}, {d[3], d[4], d[5], d[6]});
}

CurveSegment bezier_from(const BezierPoints& points_m) {
  const std::vector<BezierFinding> defects = bezier_defects(points_m, 0);
  if (!defects.empty()) refuse(defects.front().message, "a curve without a cusp");
  return BezierSegment(points_m);
}

CurveSegment segment_from(const json& segment) {
  if (segment.contains("arc")) return arc_from(segment.at("arc").get<std::array<double, 6>>());
  if (segment.contains("bezier")) return bezier_from(segment.at("bezier").get<BezierPoints>());
  if (segment.contains("direction"))
    return direction_from(segment.at("direction").get<std::array<double, 7>>());
  RationalBezier curve{segment.at("rational").get<std::vector<RationalBezier::Point>>()};
  if (curve.points.size() < 2 || curve.points.size() > RationalBezier::kMostDegree + 1)
    refuse("a rational curve of " + std::to_string(curve.points.size()) + " points", "2 to 10 points");
  return BezierSegment::rational(curve);
}

PathPiece piece_from(const json& piece) {
  if (piece.contains("turn")) {
    const auto turn = piece.at("turn").get<std::array<double, 4>>();
    return TurnInPlace{{turn[0], turn[1], turn[2]}, turn[3]};
  }
  std::vector<CurveSegment> segments;
  for (const json& segment : piece.at("segments")) segments.push_back(segment_from(segment));
  if (segments.empty()) refuse("a curve without segments", "one at least");
  return Curve(std::move(segments),
               piece.at("reverse").get<bool>() ? Direction::reverse : Direction::forward);
}

}  // namespace

json path_json(const Path& path) {
  json pieces = json::array();
  for (const PathPiece& piece : path.pieces)
    pieces.push_back(std::visit([](const auto& one) { return piece_json(one); }, piece));
  return pieces;
}

Path path_from(const json& pieces) try {
  Path path;
  for (const json& piece : pieces) path.pieces.push_back(piece_from(piece));
  return path;
} catch (const json::exception& error) {
  refuse(error.what(), "pieces in the format of an answer");
}

}  // namespace joulepath::studio
