#include "extensions/vda5050/order_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/printable.hpp"
#include "planner/path/geometry/segment_ends.hpp"
#include "planner/path/shape/corner_blend.hpp"
// Design: docs/decisions/0603-orders-and-exports.md
namespace joulepath {
namespace {

using std::numbers::pi;

constexpr double kRounding_rad = 0.01;
/// Radius of a blend; a smaller one has no advantage over a turn in place.
constexpr double kSmallestRadius_m = 0.05;
constexpr double kSharpest_rad = 2.7;
constexpr double kLongestEdge_m = 1e4;

[[noreturn]] void refuse(const ItemMarks& marks, const std::string& key, const std::string& found,
                         const std::string& accepted) {
  throw ConfigError({.mark = marks.at(key),
                     .key = marks.path + "/" + key,
                     .found = found,
                     .accepted = accepted,
                     .hint = {}});
}

std::string metres(double value_m) { return four_digits(value_m) + " m"; }

void move_to(RationalBezier::Point& point, const OrderNode& node) {
  point = {point[2] * node.x_m, point[2] * node.y_m, point[2]};
}

/// Pieces of one edge from node to node; none if both are at the same place.
std::vector<RationalBezier> pieces_of(const Order& order, std::size_t edge) {
  const OrderNode &from = order.nodes[edge], &to = order.nodes[edge + 1];
  const OrderEdge& asked = order.edges[edge];
  const double chord_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  if (chord_m > kLongestEdge_m)
    refuse(asked.marks, "edgeId", "an edge of " + metres(chord_m), "at most " + metres(kLongestEdge_m));
  if (!asked.trajectory) {
    if (chord_m < Curve::kPositionTolerance_m) return {};
    return {{{{from.x_m, from.y_m, 1}, {to.x_m, to.y_m, 1}}}};
  }
  std::vector<RationalBezier> pieces = bezier_pieces(*asked.trajectory);
  const auto check = [&](const std::array<double, 2>& end_m, const OrderNode& node, const char* which) {
    const double gap_m = std::hypot(end_m[0] - node.x_m, end_m[1] - node.y_m);
    if (gap_m > kTrajectoryRounding_m)
      refuse(asked.marks, "trajectory",
             std::string("a curve whose ") + which + " is " + metres(gap_m) + " from node " + node.id,
             "a curve from node to node, to " + metres(kTrajectoryRounding_m));
  };
  check(pieces.front().place_m(0), from, "beginning");
  check(pieces.back().place_m(pieces.back().points.size() - 1), to, "end");
  move_to(pieces.front().points.front(), from);
  move_to(pieces.back().points.back(), to);
  return pieces;
}

double tangent_rad(const RationalBezier& piece, double t) {
  const auto first_m = bezier_derivatives(piece, t).first_m;
  return std::atan2(first_m[1], first_m[0]);
}

Direction direction_of(const OrderEdge& edge, const RationalBezier& first) {
  constexpr double kTolerance_rad = 0.05;
  const double against_rad = wrapped_angle_rad(
      edge.orientation_is_global ? edge.orientation_rad - tangent_rad(first, 0) : edge.orientation_rad);
  if (std::abs(against_rad) <= kTolerance_rad) return Direction::forward;
  if (pi - std::abs(against_rad) <= kTolerance_rad) return Direction::reverse;
  refuse(edge.marks, "orientation", std::to_string(edge.orientation_rad) + " rad",
         "along the edge or against it: a differential drive cannot move sideways");
}

/// A piece of the way with the edge that it belongs to.
struct Item {
  RationalBezier piece{};
  std::size_t edge{};
  Direction direction{};
};

/// Rotates a curve's beginning by a small angle about its first point.
void rotate_beginning(RationalBezier& piece, double angle_rad) {
  const auto from = piece.place_m(0), handle = piece.place_m(1);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad), w = piece.points[1][2];
  const double x = handle[0] - from[0], y = handle[1] - from[1];
  piece.points[1] = {w * (from[0] + c * x - s * y), w * (from[1] + s * x + c * y), w};
}

/// Collects segments into curves; ends a curve at each stop of the robot.
class Builder {
 public:
  Builder(const Order& order, std::size_t first, const Pose& start)
      : order_(order), here_(start), edge_(first) {
    parts_.push_back({order.edges[first].id, 0, 0});
  }

  /// The next item; `after`: the one after it, for the blend of the corner between the two.
  void drive(Item item, Item* after) {
    if (item.edge != edge_) next_edge(item.edge);
    face(item);
    append(segment_of(item.piece), item.direction);
    if (after) blend(item, *after);
  }

  void next_edge(std::size_t edge) {
    for (; edge_ < edge; ++edge_) {
      parts_.back().to_m = length_m_;
      parts_.push_back({order_.edges[edge_ + 1].id, length_m_, 0});
      pass(order_.nodes[edge_ + 1]);
    }
  }

  /// Arrives at the last node.
  OrderPath finish(const OrderNode& node) {
    parts_.back().to_m = length_m_;
    pass(node);
    close();
    return {std::move(path_), std::move(parts_)};
  }

 private:
  Pose pose() const {
    if (open_.empty()) return path_.pieces.empty() ? here_ : path_.end();
    Pose pose = end_of(open_.back()).pose;
    if (direction_ == Direction::reverse) pose.heading_rad += pi;
    return pose;
  }

  /// Gives the robot the heading that a node requires, by a turn in place where the path has another heading.
  void pass(const OrderNode& node) {
    if (!node.heading_rad) return;
    const double off_rad = std::abs(wrapped_angle_rad(*node.heading_rad - pose().heading_rad));
    if (off_rad <= std::max(node.deviation_rad, kRounding_rad)) return;
    close();
    append_turn_to(path_, here_, *node.heading_rad);
  }

  /// Gives the robot the heading of an item: by rounding the curve's beginning, or by a turn in place.
  void face(Item& item) {
    if (!open_.empty() && item.direction != direction_) close();
    const double flip_rad = item.direction == Direction::reverse ? pi : 0.0;
    const double step_rad = wrapped_angle_rad(tangent_rad(item.piece, 0) + flip_rad - pose().heading_rad);
    if (std::abs(step_rad) <= kRounding_rad && !item.piece.straight() && !open_.empty())
      rotate_beginning(item.piece, -step_rad);
    const double rest_rad = wrapped_angle_rad(tangent_rad(item.piece, 0) + flip_rad - pose().heading_rad);
    if (std::abs(rest_rad) > Curve::kHeadingTolerance_rad) {
      close();
      append_turn_to(path_, here_, tangent_rad(item.piece, 0) + flip_rad);
      return;
    }
    if (open_.empty()) return;
    const double curvature =
        std::visit([](const auto& s) { return s.at(0).curvature_per_m; }, segment_of(item.piece));
    if (std::abs(curvature - end_of(open_.back()).curvature_per_m) > Curve::kCurvatureTolerance_per_m)
      close();
  }

  void append(CurveSegment segment, Direction direction) {
    length_m_ += std::visit([](const auto& s) { return s.length_m(); }, segment);
    direction_ = direction;
    open_.push_back(std::move(segment));
  }

  /// Rounds the corner between two straight edges within the deviation that their node allows.
  void blend(const Item& before, Item& after) {
    const OrderNode& node = order_.nodes[after.edge];
    if (before.edge + 1 != after.edge || node.heading_rad || before.direction != after.direction ||
        !before.piece.straight() || !after.piece.straight())
      return;
    const double in_rad = tangent_rad(before.piece, 0);
    const double angle_rad = wrapped_angle_rad(tangent_rad(after.piece, 0) - in_rad);
    if (std::abs(angle_rad) < kRounding_rad || std::abs(angle_rad) > kSharpest_rad) return;
    const BlendShape shape = blend_shape(angle_rad);
    // Half of the next edge is reserved for the corner at its end.
    const double rest_m =
        std::min(std::get<LinearCurvature>(open_.back()).length_m(), 0.5 * after.piece.polygon_length_m());
    const double radius_m = std::min(node.deviation_m / shape.deviation, 0.999 * rest_m / shape.tangent);
    if (radius_m < kSmallestRadius_m) return;
    shorten_and_round(before, after, shape, radius_m);
  }

  void shorten_and_round(const Item& before, Item& after, const BlendShape& shape, double radius_m) {
    const double cut_m = radius_m * shape.tangent;
    const auto corner = after.piece.place_m(0), beyond = after.piece.place_m(1);
    const auto& line = std::get<LinearCurvature>(open_.back());
    const Pose start = line.at(0).pose;
    const double kept_m = line.length_m() - cut_m;
    length_m_ -= cut_m;
    open_.back() = LinearCurvature(start, kept_m);
    const double length_m = after.piece.polygon_length_m();
    after.piece.points.front() = {corner[0] + (beyond[0] - corner[0]) * cut_m / length_m,
                                  corner[1] + (beyond[1] - corner[1]) * cut_m / length_m, 1};
    const double middle_m = length_m_ + 0.5 * radius_m * shape.length;
    for (CurveSegment& segment : blend_segments({corner[0], corner[1]}, start.heading_rad, shape, radius_m))
      append(std::move(segment), before.direction);
    parts_.back().to_m = middle_m;
    parts_.push_back({order_.edges[after.edge].id, middle_m, 0});
    edge_ = after.edge;
  }

  void close() {
    if (open_.empty()) return;
    path_.pieces.push_back(Curve(std::move(open_), direction_));
    open_.clear();
  }

  const Order& order_;
  Pose here_{};
  std::size_t edge_{};
  double length_m_{};
  Direction direction_{Direction::forward};
  std::vector<CurveSegment> open_{};
  Path path_{};
  std::vector<PathPart> parts_{};
};

std::vector<Item> items_of(const Order& order, std::size_t first, std::size_t last) {
  std::vector<Item> items;
  for (std::size_t edge = first; edge < last; ++edge) {
    std::vector<RationalBezier> pieces = pieces_of(order, edge);
    if (pieces.empty()) continue;
    const Direction direction = direction_of(order.edges[edge], pieces.front());
    for (RationalBezier& piece : pieces) items.push_back({std::move(piece), edge, direction});
  }
  return items;
}

}  // namespace

OrderPath order_path(const Order& order, std::size_t first, std::size_t last, const Pose& start) {
  Builder builder(order, first, start);
  std::vector<Item> items = items_of(order, first, last);
  for (std::size_t i = 0; i < items.size(); ++i)
    builder.drive(items[i], i + 1 < items.size() ? &items[i + 1] : nullptr);
  builder.next_edge(last - 1);
  return builder.finish(order.nodes[last]);
}

double heading_into(const Order& order, std::size_t edge) {
  const std::vector<RationalBezier> pieces = pieces_of(order, edge);
  if (pieces.empty()) return 0.0;
  const bool reverse = direction_of(order.edges[edge], pieces.front()) == Direction::reverse;
  return tangent_rad(pieces.front(), 0) + (reverse ? pi : 0.0);
}

}  // namespace joulepath
