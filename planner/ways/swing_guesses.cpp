#include "planner/ways/swing_guesses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/ways/swing_arc.hpp"

namespace joulepath {
namespace {

/// From this turn on, guesses that first swing to the other side are added.
constexpr double kSharp_rad = 1.2;
/// Lengths after which a guess joins the middle of a given curve.
constexpr double kJoinAfter_m[] = {0.6, 1.5, 3.0};
/// Knots of a guess along the whole of a given curve: from its ends, and between them at most.
constexpr double kFirstKnot_m[] = {0.5, 1.2};
constexpr double kBetweenKnots_m = 1.2;
constexpr double kHalfway_m[] = {0.15, 0.35};     ///< to a knot in the middle of a swing
constexpr double kBack_rad = 2.4;                 ///< from this turn on, swings to both sides are guessed
constexpr double kRadius_m[] = {0.1, 0.25, 0.6};  ///< of arcs
constexpr double kMostArc_rad = 5.5;
constexpr double kShortestLine_m = 0.02;               ///< between two arcs
constexpr double kAligned_rad = SwingArc::kLeast_rad;  ///< headings this close need no swing

Point2 beside(const Point2& at, double bearing, double reach_m) {
  return {at[0] + reach_m * std::cos(bearing), at[1] + reach_m * std::sin(bearing)};
}
double sign(double value) { return value < 0 ? -1.0 : 1.0; }

/// One end of a leg for the guesses: the path leaves `place` towards `bearing_rad` after a turn.
struct End {
  Point2 place{};
  double bearing_rad{};
  double turn_rad{};  ///< from the heading (away from the stop) to the bearing
  double reach_m{};   ///< distance to the other end, or to where the curve is joined

  Point2 knot(double share_m, double aside_rad) const {
    return beside(place, bearing_rad - sign(turn_rad) * aside_rad, share_m);
  }
  /// A point in the direction halfway through a turn from the heading to the bearing.
  Point2 halfway(double share_m, double by_rad) const {
    return beside(place, bearing_rad - turn_rad + 0.5 * by_rad, share_m);
  }
  /// The turn, and the one the other way round where both are long.
  std::vector<double> turns_rad() const {
    if (std::abs(turn_rad) <= kBack_rad) return {turn_rad};
    return {turn_rad, turn_rad - 2 * sign(turn_rad) * std::numbers::pi};
  }
  /// A point behind the robot, opposite to its heading: the curve then nearly turns in place.
  Point2 behind(double share_m) const {
    return beside(place, bearing_rad - turn_rad + std::numbers::pi, share_m);
  }
};

class Guesses {
 public:
  explicit Guesses(const SwingRequest& request) : request_(request) {}
  std::vector<SwingGuess> all();

 private:
  Point2 start_m() const { return {request_.start.x_m, request_.start.y_m}; }
  void add(double start_handle_m, double goal_handle_m, const std::vector<Point2>& knots,
           std::optional<double> goal_heading_rad = {}, const std::vector<std::size_t>& moving = {});
  void face(double leave_rad, double arrive_rad);
  void guess_spans();
  void guess_swings();
  void guess_arcs();
  void guess_joined();
  void guess_along();
  struct Leaving {
    double handle_m{};
    std::vector<Point2> knots{};  ///< between the end and the curve
  };
  static std::vector<Leaving> leavings(const Point2& end_m, const Point2& knot_m, double away_rad,
                                       double reach_m);

  const SwingRequest& request_;
  End from_{}, to_{};  ///< at the start, and at the goal in reversed direction
  std::vector<SwingGuess> guesses_{};
};

void Guesses::add(double start_handle_m, double goal_handle_m, const std::vector<Point2>& knots,
                  std::optional<double> goal_heading_rad, const std::vector<std::size_t>& moving) {
  SwingGuess guess{.moving = moving};
  FreeSpline& spline = guess.spline;
  spline = {.points_m = {start_m()},
            .start_heading_rad = request_.start.heading_rad,
            .start_handle_m = start_handle_m,
            .goal_heading_rad = request_.goal_heading_rad.value_or(
                goal_heading_rad.value_or(to_.bearing_rad - std::numbers::pi)),
            .goal_handle_m = goal_handle_m};
  spline.points_m.insert(spline.points_m.end(), knots.begin(), knots.end());
  spline.points_m.push_back(request_.goal_m);
  if (moving.empty())
    for (std::size_t i = 1; i <= knots.size(); ++i) guess.moving.push_back(i);
  guesses_.push_back(std::move(guess));
}

/// One span: handles from centimetres to the whole distance.
void Guesses::guess_spans() {
  const double reach_m = from_.reach_m;
  for (const double by_rad : from_.turns_rad())
    for (const double away_m : {0.3, 0.8})
      for (const double handle_m : {0.08, 0.2}) {
        const Point2 control = from_.halfway(away_m, by_rad);
        const double goal_m = distance_m(control, request_.goal_m);
        if (!request_.goal_heading_rad && away_m < 0.8 * reach_m)
          add(handle_m, goal_m, {}, bearing_rad(control, request_.goal_m));
      }
  for (const double start_m : {0.05, 0.15, 0.4, 1.0, 0.35 * reach_m})
    for (const double goal_m : {0.1, 0.4, 0.35 * reach_m})
      if (std::max(start_m, goal_m) < 0.8 * reach_m) add(start_m, goal_m, {});
  if (request_.goal_heading_rad) return;
  for (const double away_m : {0.3, 0.7, 1.5})
    for (const double aside_rad : {-0.4, 0.0, 0.5, 1.0})
      for (const double handle_m : {0.08, 0.25}) {
        const Point2 control = from_.knot(away_m, aside_rad);
        if (away_m < 0.8 * reach_m)
          add(handle_m, distance_m(control, request_.goal_m), {}, bearing_rad(control, request_.goal_m));
      }
}

/// Knots beside the start, the goal, or both, around which the curve swings.
void Guesses::guess_swings() {
  const double reach_m = from_.reach_m;
  const bool fixed = request_.goal_heading_rad.has_value();
  for (const double away_m : {0.2, 0.45, 0.9, 1.8})
    for (const double aside_rad : {0.0, 0.7})
      for (const double handle_m : {0.06, 0.2}) {
        if (away_m >= 0.7 * reach_m) continue;
        add(handle_m, 0.3 * (reach_m - away_m), {from_.knot(away_m, aside_rad)});
        if (fixed) add(0.3 * (reach_m - away_m), handle_m, {to_.knot(away_m, aside_rad)});
      }
  for (const double away_m : {0.2, 0.45, 0.9})
    for (const double aside_rad : {0.0, 0.7})
      if (fixed && away_m < 0.45 * reach_m)
        add(0.1, 0.1, {from_.knot(away_m, aside_rad), to_.knot(away_m, aside_rad)});
  for (const double away_m : {0.25, 0.5})
    for (const double handle_m : {0.1, 0.2}) {
      if (away_m >= 0.6 * reach_m) continue;
      if (std::abs(from_.turn_rad) > kSharp_rad) {
        const Point2 knot = from_.behind(away_m);
        const Point2 middle{0.5 * (knot[0] + request_.goal_m[0]), 0.5 * (knot[1] + request_.goal_m[1])};
        add(handle_m, 0.3 * reach_m, {knot});
        add(handle_m, 0.2 * reach_m, {knot, middle});
        if (fixed) add(handle_m, 0.1, {knot, to_.knot(0.45, 0.5)});
      }
      if (fixed && std::abs(to_.turn_rad) > kSharp_rad) {
        add(0.3 * reach_m, handle_m, {to_.behind(away_m)});
        add(0.1, handle_m, {from_.knot(0.45, 0.5), to_.behind(away_m)});
      }
    }
}

/// An arc, a straight line and, where the goal names a heading, another arc: every sense of rotation at both
/// ends. A swing keeps the whole turns of its first guess, as no curve without a cusp lies between two of
/// them.
void Guesses::guess_arcs() {
  const std::optional<double>& goal_rad = request_.goal_heading_rad;
  for (const double radius_m : kRadius_m)
    for (const int first : {-1, 1})
      for (const int last : goal_rad ? std::vector<int>{-1, 1} : std::vector<int>{0}) {
        const SwingArc from{start_m(), request_.start.heading_rad, first * radius_m},
            to{request_.goal_m, goal_rad.value_or(0.0), last * radius_m};
        const Point2 a = from.center_m(), b = to.center_m();
        const double aside_m = (last - first) * radius_m, apart_m = distance_m(a, b);
        if (apart_m <= std::abs(aside_m) + kShortestLine_m) continue;
        const double line_m = std::sqrt(apart_m * apart_m - aside_m * aside_m);
        const double line_rad = bearing_rad(a, b) - std::atan2(aside_m, line_m);
        const double turned_rad = positive_rad(first * (line_rad - from.heading_rad)),
                     turning_rad = goal_rad ? positive_rad(last * (*goal_rad - line_rad)) : 0.0;
        if (std::max(turned_rad, turning_rad) > kMostArc_rad) continue;
        std::vector<Point2> knots = from.knots(first * turned_rad), ending = to.knots(-last * turning_rad);
        knots.insert(knots.end(), ending.rbegin(), ending.rend());
        add(from.handle_m(turned_rad, line_m), to.handle_m(turning_rad, line_m), knots, line_rad);
      }
}

/// Keeps the middle of the given curve and replaces its ends by swings.
void Guesses::guess_joined() {
  const Curve& along = *request_.along;
  const double length_m = along.length_m();
  const bool fixed = request_.goal_heading_rad.has_value();
  for (const double after_m : kJoinAfter_m) {
    const double before_m = fixed ? after_m : 0.0;
    if (after_m + before_m > 0.8 * length_m) continue;
    std::vector<Point2> middle;
    const auto keep = [&](double s_m) {
      const Pose pose = along.at(s_m).pose;
      if (!middle.empty() && distance_m(middle.back(), {pose.x_m, pose.y_m}) < 0.05) return;
      middle.push_back({pose.x_m, pose.y_m});
    };
    keep(after_m);
    const std::vector<double>& joints_m = along.breakpoints_m();
    for (std::size_t i = 1; i < joints_m.size(); ++i)
      for (const double s_m : {0.5 * (joints_m[i - 1] + joints_m[i]), joints_m[i]})
        if (s_m > after_m + 0.3 && s_m < length_m - before_m - 0.3) keep(s_m);
    if (fixed) keep(length_m - before_m);
    const Pose last = along.at(length_m).pose;
    for (const double aside_rad : {0.0, 0.7})
      for (const double handle_m : {0.06, 0.2}) {
        const End from{start_m(), bearing_rad(start_m(), middle.front()), from_.turn_rad, after_m};
        std::vector<Point2> knots{from.knot(0.4 * after_m, aside_rad)};
        knots.insert(knots.end(), middle.begin(), middle.end());
        if (fixed) knots.push_back(to_.knot(0.4 * before_m, aside_rad));
        std::vector<std::size_t> moving{1, 2};
        if (fixed) moving.insert(moving.end(), {knots.size() - 1, knots.size()});
        add(handle_m, fixed ? handle_m : 0.3 * after_m, knots, last.heading_rad, moving);
      }
  }
}

/// Ways to leave (or reach) an end towards the first knot of a curve.
std::vector<Guesses::Leaving> Guesses::leavings(const Point2& end_m, const Point2& knot_m, double away_rad,
                                                double reach_m) {
  const double bearing = bearing_rad(end_m, knot_m);
  const End end{end_m, bearing, std::remainder(bearing - away_rad, 2 * std::numbers::pi), reach_m};
  if (std::abs(end.turn_rad) < kAligned_rad) return {{0.3 * reach_m, {}}};
  std::vector<Leaving> all{{0.1, {}}};
  for (const double away_m : kHalfway_m) {
    all.push_back({0.5 * away_m, {end.halfway(away_m, end.turn_rad)}});
    const double other_rad = end.turn_rad - 2 * sign(end.turn_rad) * std::numbers::pi;
    if (std::abs(end.turn_rad) > kBack_rad) all.push_back({0.5 * away_m, {end.halfway(away_m, other_rad)}});
  }
  return all;
}

/// Follows the whole of the given curve, with a swing at an end whose heading is another one.
void Guesses::guess_along() {
  const Curve& along = *request_.along;
  const double length_m = along.length_m();
  const double last_rad = along.at(length_m).pose.heading_rad;
  const double away_rad = request_.goal_heading_rad.value_or(last_rad) + std::numbers::pi;
  for (const double first_m : kFirstKnot_m) {
    const double rest_m = length_m - 2 * first_m;
    if (rest_m <= 0) continue;
    const auto parts = static_cast<int>(std::ceil(rest_m / kBetweenKnots_m));
    std::vector<Point2> middle;
    for (int i = 0; i <= parts; ++i) {
      const Pose pose = along.at(first_m + rest_m * i / parts).pose;
      middle.push_back({pose.x_m, pose.y_m});
    }
    for (const Leaving& from : leavings(start_m(), middle.front(), request_.start.heading_rad, first_m))
      for (const Leaving& to : leavings(request_.goal_m, middle.back(), away_rad, first_m)) {
        std::vector<Point2> knots = from.knots;
        knots.insert(knots.end(), middle.begin(), middle.end());
        knots.insert(knots.end(), to.knots.begin(), to.knots.end());
        add(from.handle_m, to.handle_m, knots, last_rad);
      }
  }
}

void Guesses::face(double leave_rad, double arrive_rad) {
  const double reach_m = distance_m(start_m(), request_.goal_m);
  from_ = {start_m(), leave_rad, std::remainder(leave_rad - request_.start.heading_rad, 2 * std::numbers::pi),
           reach_m};
  to_ = {request_.goal_m, arrive_rad + std::numbers::pi,
         std::remainder(arrive_rad - request_.goal_heading_rad.value_or(arrive_rad), 2 * std::numbers::pi),
         reach_m};
}

/// Guesses that go straight for the goal are always included, also where a curve is given: that curve may
/// belong to a goal in line of sight (for example a lead along the start's heading).
std::vector<SwingGuess> Guesses::all() {
  if (!(distance_m(start_m(), request_.goal_m) > 0.05)) return {};
  const double straight_rad = bearing_rad(start_m(), request_.goal_m);
  face(straight_rad, straight_rad);
  guess_spans();
  guess_swings();
  guess_arcs();
  if (request_.along && request_.along->segments().size() > 1) {
    face(request_.along->at(0).pose.heading_rad,
         request_.along->at(request_.along->length_m()).pose.heading_rad);
    guess_joined();
    guess_along();
  }
  return std::move(guesses_);
}

}  // namespace

std::vector<SwingGuess> swing_guesses(const SwingRequest& request) { return Guesses(request).all(); }

}  // namespace joulepath
