#include "planner/profile/front.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/progress.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/certification.hpp"
#include "planner/profile/dense_check.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath {
namespace {

struct Sum {
  double duration_s{};
  double motion_energy_J{};
  double gap_J{}, gap_s{};
};

/// One stretch, transcribed once and solved for any price of a second.
class PricedStretch {
 public:
  explicit PricedStretch(const FrontStretch& stretch)
      : request_(stretch.request), motion_(path_motion(request_)) {
    request_.time = {.mode = TimeMode::free_time};
    const std::vector<double> grid =
        stretch.grid.empty() ? nlp::make_grid(motion_, request_, request_.nodes) : stretch.grid;
    std::vector<nlp::Tightening> tightenings;
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      problem_ = nlp::transcribe(request_, motion_, grid, tightenings, nullptr);
      envelope_ = nlp::rate_envelope(problem_);
      if (envelope_.blocked) return;
      const Profile fastest = profile_from_squares(problem_.s, envelope_.fastest);
      const nlp::DenseCheck check = nlp::check_densely(
          problem_, motion_, fastest, nlp::counted_energy_J(problem_, envelope_.fastest), 1.0);
      if (check.worst_ratio <= 1 + 1e-6) break;
      tightenings.insert(tightenings.end(), check.tighten.begin(), check.tighten.end());
    }
    start_ = envelope_.fastest;
    for (std::size_t k = 1; k + 1 < start_.size(); ++k)
      start_[k] = 0.7 * envelope_.fastest[k] + 0.3 * envelope_.slowest[k];
  }
  PricedStretch(const PricedStretch&) = delete;
  PricedStretch& operator=(const PricedStretch&) = delete;

  bool blocked() const { return envelope_.blocked.has_value(); }
  const ProfileRequest& request() const { return request_; }

  std::optional<Sum> at_price(double price_W) {
    if (jerk_limited()) return planned_at_price(price_W);
    if (std::isinf(price_W) || problem_.unknown_count() == 0) return fastest();
    problem_.time_weight_W = standby_W() + price_W;
    nlp::Solution solution = nlp::solve_fast(problem_, start_, {.tolerance = 1e-8});
    if (!solution.converged) solution = nlp::solve_with_ipopt(problem_, start_);
    if (!solution.converged) return std::nullopt;
    Sum sum = sum_of(solution.b);
    SolveSummary summary;
    certify_energy(problem_, motion_, solution, profile_from_squares(problem_.s, solution.b),
                   sum.motion_energy_J, summary);
    sum.gap_J = sum.motion_energy_J + standby_W() * sum.duration_s - summary.lower_bound_J;
    return sum;
  }

 private:
  bool jerk_limited() const { return std::isfinite(request_.limits.jerk_m_s3) && !is_turn(request_.piece); }

  /// A whole plan per price: under a jerk limit the squares of the rate are not the only unknowns.
  std::optional<Sum> planned_at_price(double price_W) const {
    ProfileRequest request = request_;
    request.time = std::isinf(price_W) ? TimeGoal{.mode = TimeMode::minimum_time}
                                       : TimeGoal{.mode = TimeMode::time_price, .price_W = price_W};
    const ProfileResult result = solve_profile(request);
    if (!result.profile) return std::nullopt;
    const double energy_J = energy_by_cause(motion_, *result.profile).motion_J();
    const double duration_s = result.profile->duration_s();
    return Sum{.duration_s = duration_s,
               .motion_energy_J = energy_J,
               .gap_J = energy_J + standby_W() * duration_s - result.summary.lower_bound_J,
               .gap_s = std::isinf(price_W) ? duration_s - result.summary.lower_bound_s : 0.0};
  }

  Sum fastest() const {
    Sum sum = sum_of(envelope_.fastest);
    SolveSummary summary;
    (void)certify_time(problem_, motion_, profile_from_squares(problem_.s, envelope_.fastest), summary);
    sum.gap_J = std::nan("");
    sum.gap_s = sum.duration_s - summary.lower_bound_s;
    return sum;
  }

  Sum sum_of(const std::vector<double>& b) const {
    Sum sum{.duration_s = duration_of(problem_, b)};
    for (double energy_J : nlp::counted_energy_J(problem_, b)) sum.motion_energy_J += energy_J;
    return sum;
  }

  double standby_W() const { return request_.plant.robot.power.standby_W; }

  ProfileRequest request_;
  PathMotion motion_;
  nlp::Problem problem_{};
  nlp::RateEnvelope envelope_{};
  std::vector<double> start_{};
};

/// The price between two neighbors of the front.
double price_between_W(double high_W, double low_W, double typical_W) {
  if (std::isinf(high_W)) return 4 * std::max(low_W, 0.25 * typical_W);
  return low_W > 0 ? std::sqrt(high_W * low_W) : 0.3 * high_W;
}

/// All stretches at one price of a second; nothing where one of them could not be solved.
std::optional<FrontPoint> point_at(const std::vector<std::unique_ptr<PricedStretch>>& parts, double price_W,
                                   double standby_W) {
  FrontPoint point{.price_of_time_W = price_W};
  for (const auto& part : parts) {
    const std::optional<Sum> sum = part->at_price(price_W);
    if (!sum) return std::nullopt;
    point.duration_s += sum->duration_s;
    point.stretch_s.push_back(sum->duration_s);
    point.motion_energy_J += sum->motion_energy_J;
    point.gap_J += sum->gap_J;
    point.gap_s += sum->gap_s;
  }
  point.energy_J = point.motion_energy_J + standby_W * point.duration_s;
  return point;
}

/// The front of one drive, as far as it is drawn.
struct DriveCurve {
  std::vector<std::unique_ptr<PricedStretch>> parts{};
  FrontPoint more{};
  std::size_t drive{};
  double standby_W{};
  std::vector<FrontPoint> points{};  ///< from the fastest to the cheapest
};

DriveCurve curve_of(const FrontDrive& drive, std::size_t index) {
  DriveCurve curve{.more = drive.more, .drive = index};
  for (const FrontStretch& stretch : drive.stretches) {
    curve.parts.push_back(std::make_unique<PricedStretch>(stretch));
    curve.standby_W = stretch.request.plant.robot.power.standby_W;
    if (curve.parts.back()->blocked()) break;
  }
  return curve;
}

std::optional<FrontPoint> point_on(const DriveCurve& curve, double price_W) {
  std::optional<FrontPoint> point = point_at(curve.parts, price_W, curve.standby_W);
  if (!point) return point;
  point->duration_s += curve.more.duration_s;
  point->energy_J += curve.more.energy_J;
  point->motion_energy_J += curve.more.motion_energy_J;
  point->drive = curve.drive;
  return point;
}

/// Draws both ends of a curve, or its only point; false where a stretch could not be solved.
bool draw_ends(DriveCurve& curve, double lowest_price_W) {
  const auto fastest = point_on(curve, kNoLimit), cheapest = point_on(curve, lowest_price_W);
  if (curve.parts.empty() || !fastest || !cheapest) return false;
  constexpr double kSameTime = 1e-6;  // relative
  if (cheapest->duration_s > fastest->duration_s * (1 + kSameTime)) curve.points.push_back(*fastest);
  curve.points.push_back(*cheapest);
  finish_steps(curve.points.size());
  return true;
}

/// The energy (J) of a drive in a time or less: no less than its front's, as that is convex.
double energy_within_J(const DriveCurve& curve, double time_s) {
  const auto later =
      std::upper_bound(curve.points.begin(), curve.points.end(), time_s,
                       [](double asked_s, const FrontPoint& point) { return asked_s < point.duration_s; });
  if (later == curve.points.begin()) return kNoLimit;
  const FrontPoint& before = *std::prev(later);
  if (later == curve.points.end()) return before.energy_J;
  return std::lerp(before.energy_J, later->energy_J,
                   (time_s - before.duration_s) / (later->duration_s - before.duration_s));
}

/// The points that no other drive undercuts, in the order of time, up to a time. A least time, at which a
/// second has no price, is among them as the first one only.
std::vector<const FrontPoint*> lowest_points(const std::vector<DriveCurve>& curves, double latest_s) {
  std::vector<const FrontPoint*> lowest;
  for (const DriveCurve& curve : curves)
    for (const FrontPoint& point : curve.points) {
      const bool undercut = std::any_of(curves.begin(), curves.end(), [&](const DriveCurve& other) {
        if (other.drive == curve.drive) return false;
        const double energy_J = energy_within_J(other, point.duration_s);
        return energy_J < point.energy_J || (energy_J == point.energy_J && other.drive < curve.drive);
      });
      if (!undercut && point.duration_s <= latest_s) lowest.push_back(&point);
    }
  std::stable_sort(lowest.begin(), lowest.end(),
                   [](const FrontPoint* a, const FrontPoint* b) { return a->duration_s < b->duration_s; });
  const auto is_least_time = [](const FrontPoint* point) { return std::isinf(point->price_of_time_W); };
  if (!lowest.empty())
    lowest.erase(std::remove_if(lowest.begin() + 1, lowest.end(), is_least_time), lowest.end());
  return lowest;
}

/// The distance between two points, with the front's durations and energies weighted equally.
double gap_between(const FrontPoint& a, const FrontPoint& b, const FrontPoint& first,
                   const FrontPoint& last) {
  const double duration_s = std::max(1e-12, last.duration_s - first.duration_s);
  const double energy_J = std::max(1e-12, first.energy_J - last.energy_J);
  return std::hypot((b.duration_s - a.duration_s) / duration_s, (a.energy_J - b.energy_J) / energy_J);
}

/// The point of a curve behind which to draw the next one between two points of the front: on the curve of
/// the first or of the second, where the curve's own points are farther apart.
const FrontPoint* place_between(const std::vector<DriveCurve>& curves, const FrontPoint& a,
                                const FrontPoint& b) {
  const FrontPoint* place = nullptr;
  double most_s = -1;
  const auto offer = [&](const FrontPoint* from) {
    // Equal prices: the front is straight there, and all points between them have the same price.
    if (from[0].price_of_time_W < from[1].price_of_time_W * (1 + 1e-3)) return;
    if (from[1].duration_s - from[0].duration_s <= most_s) return;
    most_s = from[1].duration_s - from[0].duration_s;
    place = from;
  };
  if (&a != &curves[a.drive].points.back()) offer(&a);
  if (&b != &curves[b.drive].points.front()) offer(&b - 1);
  return place;
}

/// The place of the next point, in the front's widest gap; none where every gap is straight.
const FrontPoint* widest_gap(const std::vector<DriveCurve>& curves,
                             const std::vector<const FrontPoint*>& front) {
  const FrontPoint* widest = nullptr;
  double most = -1;
  for (std::size_t k = 0; k + 1 < front.size(); ++k) {
    const FrontPoint* place = place_between(curves, *front[k], *front[k + 1]);
    if (!place) continue;
    const double gap = gap_between(*front[k], *front[k + 1], *front.front(), *front.back());
    if (gap > most) most = gap, widest = place;
  }
  return widest;
}

/// Draws a point in the widest gap of a front; false where there is none to draw.
bool draw_next(std::vector<DriveCurve>& curves, const std::vector<const FrontPoint*>& front,
               double typical_W) {
  const FrontPoint* before = widest_gap(curves, front);
  if (!before) return false;
  DriveCurve& curve = curves[before->drive];
  const auto point =
      point_on(curve, price_between_W(before[0].price_of_time_W, before[1].price_of_time_W, typical_W));
  if (!point) return false;
  curve.points.insert(curve.points.begin() + (before - curve.points.data()) + 1, *point);
  finish_steps();
  return true;
}

/// Draws the lowest of several curves until it has so many points; before, each of them until it shows where
/// it is the lowest.
std::vector<FrontPoint> drawn_points(std::vector<DriveCurve>& curves, std::size_t points, double latest_s) {
  constexpr std::size_t kLeastOfEach = 10;
  constexpr std::size_t kMostTrials = 3;  // per point: a point that another drive undercuts is no point
  const FrontPoint& end = curves.front().points.back();
  const double typical_W = std::max(0.1, end.energy_J / std::max(1e-9, end.duration_s));
  const auto own_points = [](const DriveCurve& curve) {
    std::vector<const FrontPoint*> own;
    for (const FrontPoint& point : curve.points) own.push_back(&point);
    return own;
  };
  if (curves.size() > 1)
    for (const DriveCurve& curve : curves)
      while (curve.points.size() < kLeastOfEach && draw_next(curves, own_points(curve), typical_W)) continue;
  std::vector<const FrontPoint*> front = lowest_points(curves, latest_s);
  for (std::size_t trial = 0; front.size() < points && trial < kMostTrials * points; ++trial) {
    if (!draw_next(curves, front, typical_W)) break;
    front = lowest_points(curves, latest_s);
  }
  std::vector<FrontPoint> drawn;
  for (const FrontPoint* point : front) drawn.push_back(*point);
  return drawn;
}

/// Leaves out points that are next to their neighbors until so many are left.
void thin_out(std::vector<FrontPoint>& points, std::size_t most) {
  while (points.size() > std::max<std::size_t>(2, most)) {
    std::size_t nearest = 1;
    double least = kNoLimit;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
      const double gap = gap_between(points[k - 1], points[k + 1], points.front(), points.back());
      if (gap < least) least = gap, nearest = k;
    }
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(nearest));
  }
}

}  // namespace

double FrontPoint::gap_percent() const {
  return std::isnan(gap_J) ? 100 * gap_s / std::max(1e-9, duration_s)
                           : 100 * gap_J / std::max(1e-9, std::abs(energy_J));
}

SolveStatus FrontPoint::status(double accuracy) const {
  return gap_percent() <= 100 * accuracy ? SolveStatus::optimal : SolveStatus::feasible;
}

Front energy_time_front(const std::vector<FrontStretch>& stretches, std::size_t points,
                        double lowest_price_W) {
  return lowest_front({FrontDrive{.stretches = stretches}}, points, lowest_price_W);
}

Front lowest_front(const std::vector<FrontDrive>& drives, std::size_t points, double lowest_price_W) {
  Front front;
  std::vector<DriveCurve> curves;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    curves.push_back(curve_of(drives[k], k));
    DriveCurve& curve = curves.back();
    const bool blocked = !curve.parts.empty() && curve.parts.back()->blocked();
    if ((!blocked && draw_ends(curve, lowest_price_W)) || k > 0) continue;
    front.summary.message = "no front: a stretch could not be solved";
    if (!blocked) return front;
    ProfileResult result = solve_profile(curve.parts.back()->request());
    front.summary = result.summary;
    front.infeasibility = result.infeasibility;
    return front;
  }
  const double latest_s = lowest_price_W > 0 ? curves.front().points.back().duration_s : kNoLimit;
  front.points = drawn_points(curves, points, latest_s);
  thin_out(front.points, points);
  if (front.points.size() == 1)
    front.summary.message = "the least time is the cheapest: no slower drive saves energy";
  front.summary.status = SolveStatus::optimal;
  front.summary.solver = "fast";
  return front;
}

}  // namespace joulepath
