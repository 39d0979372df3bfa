#include "planner/joint/joint_starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace joulepath::joint {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeastArc_m = 0.08, kLeastLine_m = 0.06;
constexpr double kMostArc_rad = 5.2;  ///< of an arc of a word
constexpr double kNone_rad = 0.03;    ///< a whole turn less than this is none
constexpr double kRouteRadius_m = 0.25, kBendRadius_m = 0.5;
constexpr double kMostPhi_rad = 1.4;
constexpr double kBendWeight = 2;      ///< of phi's change among the knots of a path; of its whole length: 3
constexpr double kMostJump_rad = 0.3;  ///< of what counts of a jump, which one piece holds

double sense_turn_rad(double turn_rad, int sense) {
  const double shorter = std::remainder(turn_rad, 2 * kPi);
  if (sense == 0) return shorter;
  double turn = sense * std::fmod(sense * shorter + 2 * kPi, 2 * kPi);
  return std::abs(turn) > 2 * kPi - kNone_rad ? 0.0 : turn;
}

/// Two pieces that turn at a radius and lead to or from a straight line.
void append_arc(Sketch& sketch, double turn_rad, double radius_m, double half_track_m, bool first) {
  double phi = std::atan2(half_track_m, radius_m);
  const double across = std::abs(turn_rad) * half_track_m / 1.5;
  const double length_m = std::max(kLeastArc_m, across / std::sin(phi));
  phi = std::copysign(std::asin(std::min(0.95, across / length_m)), turn_rad);
  if (first) {
    sketch.parts.push_back({phi, phi, length_m});
    sketch.parts.push_back({phi, 0, length_m});
  } else {
    sketch.parts.push_back({0, phi, length_m});
    sketch.parts.push_back({phi, phi, length_m});
  }
}

void append_bend(Sketch& sketch, double turn_rad, double half_track_m) {
  const double phi = std::atan2(half_track_m, kBendRadius_m), across = std::abs(turn_rad) * half_track_m;
  const double length_m = std::max(0.1, across / std::sin(phi));
  const double bend = std::copysign(std::asin(std::min(0.9, across / length_m)), turn_rad);
  sketch.parts.push_back({0, bend, length_m});
  sketch.parts.push_back({bend, 0, length_m});
}

void append_line(Sketch& sketch, double length_m) {
  sketch.parts.push_back({0, 0, std::max(kLeastLine_m, length_m)});
}

/// How much of a route's sides the bend at a corner replaces.
double cut_m(const std::vector<Point2>& route_m, std::size_t corner) {
  const Point2 &a = route_m[corner - 1], &b = route_m[corner], &c = route_m[corner + 1];
  const double in_m = distance_m(a, b), out_m = distance_m(b, c);
  const double turn =
      std::remainder(std::atan2(c[1] - b[1], c[0] - b[0]) - std::atan2(b[1] - a[1], b[0] - a[0]), 2 * kPi);
  return std::min({kBendRadius_m * std::tan(0.5 * std::min(std::abs(turn), 2.5)), 0.4 * in_m, 0.4 * out_m});
}

/// The word that turns to `first`, drives straight and turns to `last` (0: any heading at the goal).
std::optional<Sketch> word(const Pose& start, const LegGoal& goal, double half_track_m, int first, int last,
                           double radius_m) {
  const auto center = [&](double x_m, double y_m, double heading_rad, int sense) {
    return Point2{x_m - sense * radius_m * std::sin(heading_rad),
                  y_m + sense * radius_m * std::cos(heading_rad)};
  };
  const Point2 from = center(start.x_m, start.y_m, start.heading_rad, first);
  const Point2 to = last ? center(goal.at_m[0], goal.at_m[1], *goal.heading_rad, last) : goal.at_m;
  const double offset_m = (last - first) * radius_m;
  const double apart_m = std::hypot(to[0] - from[0], to[1] - from[1]);
  if (apart_m <= std::abs(offset_m) + 0.02) return std::nullopt;
  const double line_m = std::sqrt(apart_m * apart_m - offset_m * offset_m);
  const double heading_rad = std::atan2(to[1] - from[1], to[0] - from[0]) - std::atan2(offset_m, line_m);
  const double begin_rad = sense_turn_rad(heading_rad - start.heading_rad, first);
  const double end_rad = last ? sense_turn_rad(*goal.heading_rad - heading_rad, last) : 0.0;
  if (std::abs(begin_rad) > kMostArc_rad || std::abs(end_rad) > kMostArc_rad) return std::nullopt;
  Sketch sketch;
  append_arc(sketch, std::copysign(begin_rad, first), radius_m, half_track_m, true);
  const int lines = last ? 2 : 3;
  for (int i = 0; i < lines; ++i) append_line(sketch, line_m / lines);
  if (last) append_arc(sketch, std::copysign(end_rad, last), radius_m, half_track_m, false);
  return sketch;
}

/// Direction phi and place along a path by its length tau.
struct Course {
  std::vector<double> tau_m{0}, phi_rad{};
  std::vector<Point2> place_m{};      ///< after each step
  std::vector<double> turned_rad{0};  ///< since the begin, as tau
  void add(double length_m, double phi, double half_track_m, const Pose& at_end) {
    tau_m.push_back(tau_m.back() + length_m);
    phi_rad.push_back(phi);
    place_m.push_back({at_end.x_m, at_end.y_m});
    turned_rad.push_back(turned_rad.back() + length_m * std::sin(phi) / half_track_m);
  }
  /// The first sample that ends at or after tau, counted from 1.
  std::size_t after(double tau) const {
    return static_cast<std::size_t>(std::lower_bound(tau_m.begin() + 1, tau_m.end() - 1, tau) -
                                    tau_m.begin());
  }
};

Course course_of(std::span<const PathPiece> pieces, double half_track_m) {
  constexpr double kSample_m = 0.05, kLeastSamples = 120;
  Course course;
  for (const PathPiece& piece : pieces) {
    const double length = piece_length(piece);
    const double samples =
        is_turn(piece) ? kLeastSamples : std::max(kLeastSamples, std::ceil(length / kSample_m));
    const double step = length / samples;
    for (double i = 0; i < samples; ++i) {
      if (is_turn(piece)) {
        course.add(step * half_track_m, turn_sign(piece) * 0.5 * kPi, half_track_m,
                   piece_point(piece, 0).pose);
        continue;
      }
      const double across = half_track_m * piece_bend(piece, (i + 0.5) * step).curvature_per_m;
      course.add(step * std::hypot(1.0, across), std::atan(across), half_track_m,
                 piece_point(piece, (i + 1) * step).pose);
    }
  }
  return course;
}

/// Direction at knots, linear in between, with the least square error: what it turns between the knots is
/// what the course turns.
Eigen::VectorXd projected(const Course& course, const std::vector<double>& knots) {
  const auto count = static_cast<Eigen::Index>(knots.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(count, count) * 1e-9;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  std::size_t k = 0;
  for (std::size_t i = 0; i < course.phi_rad.size(); ++i) {
    const double weight = course.tau_m[i + 1] - course.tau_m[i];
    const double tau = 0.5 * (course.tau_m[i] + course.tau_m[i + 1]);
    while (k + 2 < knots.size() && knots[k + 1] < tau) ++k;
    const double share = (tau - knots[k]) / (knots[k + 1] - knots[k]);
    const Eigen::Vector2d hats{1 - share, share};
    const auto at = static_cast<Eigen::Index>(k);
    normal.block<2, 2>(at, at) += weight * hats * hats.transpose();
    right.segment<2>(at) += weight * course.phi_rad[i] * hats;
  }
  return normal.ldlt().solve(right).cwiseMin(kMostPhi_rad).cwiseMax(-kMostPhi_rad);
}

/// `turned_rad`: by what stands before the pieces.
Sketch along_pieces(std::span<const PathPiece> pieces, double half_track_m, std::size_t count,
                    double turned_rad) {
  const Course course = course_of(pieces, half_track_m);
  const double whole_m = course.tau_m.back();
  std::vector<double> weight{0.0};
  for (std::size_t i = 0; i < course.phi_rad.size(); ++i) {
    const double change =
        i > 0 ? std::min(std::abs(course.phi_rad[i] - course.phi_rad[i - 1]), kMostJump_rad) : 0.0;
    weight.push_back(weight.back() + kBendWeight * change +
                     3 * (course.tau_m[i + 1] - course.tau_m[i]) / whole_m);
  }
  std::vector<double> knots{0.0};
  for (std::size_t k = 1; k < count; ++k) {
    const double part = weight.back() * static_cast<double>(k) / static_cast<double>(count);
    const auto at =
        static_cast<std::size_t>(std::lower_bound(weight.begin(), weight.end(), part) - weight.begin());
    knots.push_back(std::max(course.tau_m[at], knots.back() + kShortestPiece_m));
  }
  knots.push_back(std::max(whole_m, knots.back() + kShortestPiece_m));
  const Eigen::VectorXd phi_rad = projected(course, knots);
  Sketch sketch;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const std::size_t at = course.after(knots[k + 1]);
    sketch.parts.push_back({.from_rad = phi_rad[static_cast<Eigen::Index>(k)],
                            .to_rad = phi_rad[static_cast<Eigen::Index>(k) + 1],
                            .length_m = knots[k + 1] - knots[k],
                            .through_m = course.place_m[at - 1],
                            .turned_rad = turned_rad + course.turned_rad[at]});
  }
  return sketch;
}

Pose turned(Pose pose) {
  pose.heading_rad += kPi;
  return pose;
}

}  // namespace

double Sketch::turn_rad(double half_track_m) const {
  double turn = 0;
  for (const Part& part : parts)
    turn += 0.5 * part.length_m * (std::sin(part.from_rad) + std::sin(part.to_rad)) / half_track_m;
  return turn;
}

double Sketch::effort_m() const {
  double sum = 0;
  for (const Part& part : parts)
    sum += part.length_m * (1 + std::abs(std::sin(part.from_rad) + std::sin(part.to_rad)));
  return sum;
}

Sketch reversed(Sketch sketch) {
  for (Sketch::Part& part : sketch.parts)
    part = {kPi - part.from_rad, kPi - part.to_rad, part.length_m,  -part.sign,
            part.rests_after,    part.through_m,    part.turned_rad};
  return sketch;
}

bool Sketch::Part::turns_in_place() const { return std::abs(std::cos(from_rad)) < 1e-9; }

Sketch turn(double turn_rad, double half_track_m) {
  const double phi = std::copysign(0.5 * kPi, turn_rad);
  return {{{.from_rad = phi,
            .to_rad = phi,
            .length_m = std::max(kShortestTurn_m, std::abs(turn_rad) * half_track_m),
            .rests_after = true}}};
}

Pose moved(Pose pose, double along_m) {
  pose.x_m += along_m * std::cos(pose.heading_rad);
  pose.y_m += along_m * std::sin(pose.heading_rad);
  return pose;
}

Sketch straight(double along_m) {
  Sketch line{{{0, 0, std::abs(along_m)}}};
  return along_m < 0 ? reversed(std::move(line)) : line;
}

void append(Sketch& sketch, const Sketch& next) {
  if (!sketch.parts.empty()) sketch.parts.back().rests_after = true;
  sketch.parts.insert(sketch.parts.end(), next.parts.begin(), next.parts.end());
}

LegGoal turned(LegGoal goal) {
  if (goal.heading_rad) *goal.heading_rad += kPi;
  return goal;
}

std::vector<Sketch> reverse_words(const Pose& start, const LegGoal& goal, double half_track_m,
                                  const std::vector<double>& radii_m) {
  std::vector<Sketch> found = words(turned(start), turned(goal), half_track_m, radii_m);
  for (Sketch& sketch : found) sketch = reversed(std::move(sketch));
  return found;
}

std::vector<Sketch> cusp_words(const Pose& start, const LegGoal& goal, double half_track_m,
                               const std::vector<double>& radii_m, const std::vector<double>& straight_m) {
  std::vector<Sketch> found;
  const auto between = [&](const Pose& from, const LegGoal& to, bool reverse) {
    return reverse ? reverse_words(from, to, half_track_m, radii_m) : words(from, to, half_track_m, radii_m);
  };
  for (const double length_m : straight_m)
    for (const double out_m : {-length_m, length_m}) {
      for (const Sketch& rest : between(moved(start, out_m), goal, out_m > 0))
        append(found.emplace_back(straight(out_m)), rest);
      if (!goal.heading_rad) continue;
      const Pose before = moved({goal.at_m[0], goal.at_m[1], *goal.heading_rad}, out_m);
      for (const Sketch& first : between(start, {{before.x_m, before.y_m}, goal.heading_rad}, out_m < 0))
        append(found.emplace_back(first), straight(-out_m));
    }
  return found;
}

std::vector<Sketch> words(const Pose& start, const LegGoal& goal, double half_track_m,
                          const std::vector<double>& radii_m) {
  const double apart_m = std::hypot(goal.at_m[0] - start.x_m, goal.at_m[1] - start.y_m);
  std::vector<Sketch> words;
  double before_m = 0;
  for (const double wanted_m : radii_m) {
    const double radius_m = std::min(wanted_m, std::max(0.05, 0.22 * apart_m));
    if (before_m > 0 && std::abs(radius_m / before_m - 1) < 0.2) continue;
    before_m = radius_m;
    for (const int first : {1, -1})
      for (const int last : goal.heading_rad ? std::vector<int>{1, -1} : std::vector<int>{0})
        if (auto sketch = word(start, goal, half_track_m, first, last, radius_m))
          words.push_back(std::move(*sketch));
  }
  return words;
}

Sketch along_route(const Pose& start, const std::vector<Point2>& route_m,
                   const std::optional<double>& heading_rad, int first, int last, double half_track_m) {
  Sketch sketch;
  double heading = start.heading_rad;
  for (std::size_t i = 0; i + 1 < route_m.size(); ++i) {
    const double bearing_rad =
        std::atan2(route_m[i + 1][1] - route_m[i][1], route_m[i + 1][0] - route_m[i][0]);
    const auto on_side = [&](const Point2& corner, double along_m) {
      return Point2{corner[0] + along_m * std::cos(bearing_rad), corner[1] + along_m * std::sin(bearing_rad)};
    };
    const double turn = sense_turn_rad(bearing_rad - heading, i == 0 ? first : 0);
    if (i == 0) {
      append_arc(sketch, turn, kRouteRadius_m, half_track_m, true);
    } else {
      append_bend(sketch, turn, half_track_m);
      sketch.parts.back().through_m = on_side(route_m[i], cut_m(route_m, i));
    }
    append_line(sketch, std::max(0.15, 0.8 * distance_m(route_m[i], route_m[i + 1])));
    if (i + 2 < route_m.size())
      sketch.parts.back().through_m = on_side(route_m[i + 1], -cut_m(route_m, i + 1));
    heading += turn;
  }
  const double end_rad = heading_rad ? sense_turn_rad(*heading_rad - heading, last) : 0.0;
  append_arc(sketch, end_rad, kRouteRadius_m, half_track_m, false);
  return sketch;
}

Sketch along_route_turning(const Pose& start, const std::vector<Point2>& route_m,
                           const std::optional<double>& heading_rad, int first, int last,
                           double half_track_m) {
  Sketch sketch;
  Pose from = start;
  if (first != 0) {
    from.heading_rad = bearing_rad(route_m[0], route_m[1]);
    sketch = turn(sense_turn_rad(from.heading_rad - start.heading_rad, first), half_track_m);
  }
  append(sketch, along_route(from, route_m, last == 0 ? heading_rad : std::nullopt, 0, 0, half_track_m));
  if (last != 0)
    append(sketch,
           turn(sense_turn_rad(*heading_rad - bearing_rad(route_m[route_m.size() - 2], route_m.back()), last),
                half_track_m));
  return sketch;
}

Sketch along_path(const Path& path, double half_track_m, std::size_t count, Turns turns) {
  const auto share = [&](std::size_t from, std::size_t to) {
    constexpr double kLeastPieces = 3;
    double length_m = 0;
    for (std::size_t k = from; k < to; ++k)
      if (!is_turn(path.pieces[k])) length_m += piece_length(path.pieces[k]);
    const double wanted = std::ceil(static_cast<double>(count) * length_m / path.distance_m());
    return static_cast<std::size_t>(std::max(kLeastPieces, wanted));
  };
  Sketch sketch;
  for (std::size_t from = 0, to = 0; from < path.pieces.size(); from = to) {
    const double before_rad = sketch.parts.empty() ? 0.0 : *sketch.parts.back().turned_rad;
    if (turns == Turns::in_place && is_turn(path.pieces[from])) {
      const double turn_rad = turn_sign(path.pieces[from]) * piece_length(path.pieces[from]);
      Sketch part = turn(turn_rad, half_track_m);
      part.parts.front().turned_rad = before_rad + turn_rad;
      append(sketch, part);
      to = from + 1;
      continue;
    }
    int sign = 0;
    for (to = from; to < path.pieces.size(); ++to) {
      if (turns == Turns::in_place && is_turn(path.pieces[to])) break;
      const int next = travel_sign(path.pieces[to]);
      if (sign * next < 0) break;
      if (next != 0) sign = next;
    }
    Sketch part = along_pieces(std::span(path.pieces).subspan(from, to - from), half_track_m,
                               turns == Turns::in_place ? share(from, to) : count, before_rad);
    if (sign < 0) part = reversed(std::move(part));
    append(sketch, part);
  }
  return sketch;
}

Start assemble(const std::vector<Sketch>& legs, const std::vector<LegGoal>& goals, const Pose& start,
               double half_track_m, std::size_t segments) {
  Start built;
  Program& program = built.program;
  program.frame = start;
  std::vector<double> phi, lengths;
  double turned = 0;
  const auto in_frame = [&, c = std::cos(start.heading_rad),
                         s = std::sin(start.heading_rad)](const Point2& at) {
    const double dx = at[0] - start.x_m, dy = at[1] - start.y_m;
    return Point2{c * dx + s * dy, c * dy - s * dx};
  };
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    for (const Sketch::Part& part : legs[leg].parts) {
      const bool jumps = program.pieces.empty() || program.pieces.back().rests_after;
      if (jumps) phi.push_back(part.from_rad);
      const auto from = static_cast<Eigen::Index>(phi.size()) - 1;
      phi.push_back(part.to_rad);
      lengths.push_back(part.length_m);
      program.pieces.push_back({.from = from,
                                .to = from + 1,
                                .sign = part.sign,
                                .leg = leg,
                                .law = part.sign > 0 ? leg : legs.size() + leg,
                                .rests_after = part.rests_after,
                                .segments = segments,
                                .turns = part.turns_in_place()});
      if (!part.through_m) continue;
      program.waypoints.push_back({program.pieces.size() - 1, in_frame(*part.through_m)});
      if (part.turned_rad) program.waypoints.back().heading_rad = turned + *part.turned_rad;
    }
    program.pieces.back().rests_after = true;
    turned += legs[leg].parts.back().turned_rad.value_or(legs[leg].turn_rad(half_track_m));
    const LegGoal& goal = goals[leg];
    Target target{.piece = program.pieces.size() - 1, .at_m = in_frame(goal.at_m)};
    if (goal.heading_rad)
      target.heading_rad = turned + std::remainder(*goal.heading_rad - start.heading_rad - turned, 2 * kPi);
    program.targets.push_back(target);
  }
  program.knots = static_cast<Eigen::Index>(phi.size());
  phi.insert(phi.end(), lengths.begin(), lengths.end());
  built.parameters = Eigen::Map<Eigen::VectorXd>(phi.data(), static_cast<Eigen::Index>(phi.size()));
  return built;
}

}  // namespace joulepath::joint
