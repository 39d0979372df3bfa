#include "planner/ways/swing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "planner/path/shape/nlopt_run.hpp"

namespace joulepath {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kClearanceMargin_m = 0.002;
constexpr double kShortestHandle_m = 0.01;
constexpr double kSharp_rad = 1.2;         ///< from this turn on a curve may first swing to the other side
constexpr double kFirstStep_m = 0.15;      ///< of knots and long handles
constexpr double kFirstTurn_rad = 0.3;     ///< of a free goal heading
constexpr std::size_t kPolishedKnots = 4;  ///< the most knots that move
constexpr std::size_t kSameSpans = 2;      ///< polished guesses with one number of spans
constexpr double kJoinAfter_m[] = {0.6, 1.5, 3.0};  ///< of a curved leg that is kept in its middle

struct Guess {
  FreeSpline spline{};
  std::vector<std::size_t> moving{};  ///< knots that are polished
  double value{};
};

double distance_m(const Point2& a, const Point2& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }
double bearing_rad(const Point2& a, const Point2& b) { return std::atan2(b[1] - a[1], b[0] - a[0]); }
Point2 beside(const Point2& at, double bearing, double reach_m) {
  return {at[0] + reach_m * std::cos(bearing), at[1] + reach_m * std::sin(bearing)};
}
double sign(double value) { return value < 0 ? -1.0 : 1.0; }

/// One end of a leg as its guesses see it: the path leaves `place` towards `bearing_rad` after a turn.
struct End {
  Point2 place{};
  double bearing_rad{};
  double turn_rad{};  ///< from the heading (away from the stop) to the bearing
  double reach_m{};   ///< to the other end, or to where the curve is joined

  Point2 knot(double share_m, double aside_rad) const {
    return beside(place, bearing_rad - sign(turn_rad) * aside_rad, share_m);
  }
  /// Straight back against the heading: the curve then swings round on the spot, nearly.
  Point2 behind(double share_m) const {
    return beside(place, bearing_rad - turn_rad + std::numbers::pi, share_m);
  }
};

/// Subplex from x with these first steps; x is moved to the best point seen. Returns the value there.
double minimize(std::vector<double>& x, const std::vector<double>& step, const std::vector<double>& lower,
                const SwingOptions& options, const std::function<double(const std::vector<double>&)>& value) {
  nlopt::opt optimizer(nlopt::LN_SBPLX, static_cast<unsigned>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::max(x[i], lower[i]);
  optimizer.set_lower_bounds(lower);
  optimizer.set_initial_step(step);
  optimizer.set_min_objective(
      [](const std::vector<double>& at, std::vector<double>&, void* data) {
        return (*static_cast<const std::function<double(const std::vector<double>&)>*>(data))(at);
      },
      const_cast<std::function<double(const std::vector<double>&)>*>(&value));
  optimizer.set_ftol_rel(options.relative_tolerance);
  optimizer.set_xtol_rel(1e-5);
  optimizer.set_maxeval(options.evaluations_per_variable * static_cast<int>(x.size()));
  const std::optional<double> found = optimize_as_far_as_possible(optimizer, x);
  return found ? *found : value(x);
}

/// 0 where a path is free, else a value above every cost that grows with the depth of the collision.
constexpr double kBlocked = 1e9;
double blocked(const FootprintChecker& checker, const Path& path) {
  const double slack_m = checker.least_slack_m(path);
  return slack_m < kClearanceMargin_m ? kBlocked * (1 + std::min(1.0, kClearanceMargin_m - slack_m)) : 0.0;
}

class Swing {
 public:
  Swing(const SwingRequest& request, const FootprintChecker& checker, const PathCost& cost,
        const SwingOptions& options)
      : request_(request), checker_(checker), cost_(cost), options_(options) {}

  std::optional<SwingResult> run();

 private:
  Point2 start_m() const { return {request_.start.x_m, request_.start.y_m}; }
  void add(double start_handle_m, double goal_handle_m, const std::vector<Point2>& knots,
           std::optional<double> goal_heading_rad = {}, const std::vector<std::size_t>& moving = {});
  void guess_spans();
  void guess_swings();
  void guess_joined();
  void polish(Guess& guess, double first_step_m);
  double value(const FreeSpline& spline);

  const SwingRequest& request_;
  const FootprintChecker& checker_;
  const PathCost& cost_;
  const SwingOptions& options_;
  End from_{}, to_{};  ///< at the start and, seen backward, at the goal
  std::vector<Guess> guesses_{};
  std::optional<SwingResult> best_{};
  int evaluations_{};
};

/// The cost, or a value above every cost where the spline cannot be driven.
double Swing::value(const FreeSpline& spline) {
  ++evaluations_;
  std::optional<Path> path = free_spline_path(spline);
  if (!path) return 3 * kBlocked;
  if (const double in_the_way = blocked(checker_, *path)) return in_the_way;
  const double cost = cost_(*path);
  if (!std::isfinite(cost)) return 2.5 * kBlocked;
  if ((!best_ || cost < best_->cost) && !checker_.first_collision(*path))
    best_ = {.spline = spline, .path = std::move(*path), .cost = cost};
  return cost;
}

void Swing::add(double start_handle_m, double goal_handle_m, const std::vector<Point2>& knots,
                std::optional<double> goal_heading_rad, const std::vector<std::size_t>& moving) {
  Guess guess{.moving = moving};
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
  guess.value = value(spline);
  guesses_.push_back(std::move(guess));
}

/// One span: handles from centimetres to the whole distance.
void Swing::guess_spans() {
  const double reach_m = from_.reach_m;
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

/// Knots beside the start, the goal, or both, round which the curve swings.
void Swing::guess_swings() {
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

/// The middle of the given curve is kept; its ends are replaced by swings.
void Swing::guess_joined() {
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

/// Variables: both handles, a free goal heading, the moving knots.
void Swing::polish(Guess& guess, double first_step_m) {
  const bool free_heading = !request_.goal_heading_rad;
  if (guess.moving.size() > kPolishedKnots) guess.moving.resize(kPolishedKnots);
  const FreeSpline first = guess.spline;
  const auto spline_at = [&](const std::vector<double>& x) {
    FreeSpline spline = first;
    std::size_t i = 0;
    spline.start_handle_m = x[i++];
    spline.goal_handle_m = x[i++];
    if (free_heading) spline.goal_heading_rad = x[i++];
    for (const std::size_t knot : guess.moving) {
      spline.points_m[knot] = {x[i], x[i + 1]};
      i += 2;
    }
    return spline;
  };
  std::vector<double> x{first.start_handle_m, first.goal_handle_m};
  std::vector<double> step{std::min(first_step_m, 0.5 * x[0]), std::min(first_step_m, 0.5 * x[1])};
  if (free_heading) x.push_back(first.goal_heading_rad), step.push_back(kFirstTurn_rad);
  for (const std::size_t knot : guess.moving)
    for (const double coordinate : first.points_m[knot]) {
      x.push_back(coordinate);
      step.push_back(first_step_m);
    }
  std::vector<double> lower(x.size(), -kInfinity);
  lower[0] = lower[1] = kShortestHandle_m;
  const double found =
      minimize(x, step, lower, options_, [&](const std::vector<double>& at) { return value(spline_at(at)); });
  if (found >= guess.value) return;
  guess.value = found;
  guess.spline = spline_at(x);
}

std::optional<SwingResult> Swing::run() {
  const double reach_m = distance_m(start_m(), request_.goal_m);
  if (!(reach_m > 0.05)) return std::nullopt;
  const bool curved = request_.along && request_.along->segments().size() > 1;
  const double leave_rad =
      curved ? request_.along->at(0).pose.heading_rad : bearing_rad(start_m(), request_.goal_m);
  const double arrive_rad =
      curved ? request_.along->at(request_.along->length_m()).pose.heading_rad : leave_rad;
  from_ = {start_m(), leave_rad, std::remainder(leave_rad - request_.start.heading_rad, 2 * std::numbers::pi),
           reach_m};
  to_ = {request_.goal_m, arrive_rad + std::numbers::pi,
         std::remainder(arrive_rad - request_.goal_heading_rad.value_or(arrive_rad), 2 * std::numbers::pi),
         reach_m};
  if (curved) {
    guess_joined();
  } else {
    guess_spans();
    guess_swings();
  }
  const auto cheaper = [](const Guess& a, const Guess& b) { return a.value < b.value; };
  std::stable_sort(guesses_.begin(), guesses_.end(), cheaper);
  std::vector<Guess> picked;
  for (const Guess& guess : guesses_) {
    const auto alike = std::count_if(picked.begin(), picked.end(), [&](const Guess& other) {
      return other.spline.points_m.size() == guess.spline.points_m.size();
    });
    if (picked.size() < options_.starts && static_cast<std::size_t>(alike) < kSameSpans)
      picked.push_back(guess);
  }
  for (Guess& guess : picked) polish(guess, kFirstStep_m);
  std::stable_sort(picked.begin(), picked.end(), cheaper);
  if (!picked.empty()) polish(picked.front(), 0.3 * kFirstStep_m);
  if (best_) best_->evaluations = evaluations_;
  return std::move(best_);
}

}  // namespace

std::optional<SwingResult> best_swing(const SwingRequest& request, const FootprintChecker& checker,
                                      const PathCost& cost, const SwingOptions& options) {
  return Swing(request, checker, cost, options).run();
}

std::optional<StopResult> best_stop(const StopRequest& request, const FootprintChecker& checker,
                                    const SwingOptions& options) {
  std::optional<StopResult> best;
  const bool knot_before = request.before.points_m.size() > 2, knot_after = request.after.points_m.size() > 2;
  const auto splines_at = [&](const std::vector<double>& x) {
    std::pair<FreeSpline, FreeSpline> splines{request.before, request.after};
    auto& [before, after] = splines;
    std::size_t i = 0;
    before.goal_handle_m = x[i++];
    after.start_handle_m = x[i++];
    before.goal_heading_rad = after.start_heading_rad = x[i++];
    if (knot_before) before.points_m[before.points_m.size() - 2] = {x[i], x[i + 1]}, i += 2;
    if (knot_after) after.points_m[1] = {x[i], x[i + 1]};
    return splines;
  };
  const auto value = [&](const std::vector<double>& x) {
    const auto [before, after] = splines_at(x);
    std::optional<Path> first = free_spline_path(before), second = free_spline_path(after);
    if (!first || !second) return 3 * kBlocked;
    if (const double in_the_way = blocked(checker, *first) + blocked(checker, *second)) return in_the_way;
    const double cost = request.cost(*first, *second);
    if (!std::isfinite(cost)) return 2.5 * kBlocked;
    if ((!best || cost < best->cost) && !checker.first_collision(*first) && !checker.first_collision(*second))
      best = {.before = {.spline = before, .path = std::move(*first)},
              .after = {.spline = after, .path = std::move(*second)},
              .cost = cost};
    return cost;
  };
  for (const double heading_rad : {request.after.start_heading_rad, request.before.goal_heading_rad}) {
    std::vector<double> x{request.before.goal_handle_m, request.after.start_handle_m, heading_rad};
    std::vector<double> step{0.5 * x[0], 0.5 * x[1], kFirstTurn_rad};
    const auto append = [&](const Point2& knot) {
      x.insert(x.end(), knot.begin(), knot.end());
      step.insert(step.end(), 2, kFirstStep_m);
    };
    if (knot_before) append(request.before.points_m[request.before.points_m.size() - 2]);
    if (knot_after) append(request.after.points_m[1]);
    std::vector<double> lower(x.size(), -kInfinity);
    lower[0] = lower[1] = kShortestHandle_m;
    minimize(x, step, lower, options, value);
    if (request.after.start_heading_rad == request.before.goal_heading_rad) break;
  }
  return best;
}

}  // namespace joulepath
