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

/// The place of the next point: after the front's widest gap, with durations and energies weighted equally.
std::size_t widest_gap(const std::vector<FrontPoint>& points) {
  const double duration_s = std::max(1e-12, points.back().duration_s - points.front().duration_s);
  const double energy_J = std::max(1e-12, points.front().energy_J - points.back().energy_J);
  std::size_t widest = 0;
  double most = -1;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    // Equal prices: the front is straight there, and all points between them have the same price.
    if (points[k].price_of_time_W < points[k + 1].price_of_time_W * (1 + 1e-3)) continue;
    const double gap = std::hypot((points[k + 1].duration_s - points[k].duration_s) / duration_s,
                                  (points[k].energy_J - points[k + 1].energy_J) / energy_J);
    if (gap > most) most = gap, widest = k;
  }
  return widest;
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
  Front front;
  std::vector<std::unique_ptr<PricedStretch>> parts;
  double standby_W = 0;
  for (const FrontStretch& stretch : stretches) {
    parts.push_back(std::make_unique<PricedStretch>(stretch));
    standby_W = stretch.request.plant.robot.power.standby_W;
    if (!parts.back()->blocked()) continue;
    ProfileResult result = solve_profile(parts.back()->request());
    front.summary = result.summary;
    front.infeasibility = result.infeasibility;
    return front;
  }
  const auto fastest = point_at(parts, kNoLimit, standby_W),
             cheapest = point_at(parts, lowest_price_W, standby_W);
  if (parts.empty() || !fastest || !cheapest) {
    front.summary.message = "no front: a stretch could not be solved";
    return front;
  }
  constexpr double kSameTime = 1e-6;  // relative
  if (cheapest->duration_s <= fastest->duration_s * (1 + kSameTime)) {
    front.points = {*cheapest};
    front.summary.message = "the least time is the cheapest: no slower drive saves energy";
    points = 1;
  } else {
    front.points = {*fastest, *cheapest};
  }
  finish_steps(front.points.size());
  const double typical_W = std::max(0.1, cheapest->energy_J / std::max(1e-9, cheapest->duration_s));
  while (front.points.size() < points) {
    const std::size_t k = widest_gap(front.points);
    const double price_W =
        price_between_W(front.points[k].price_of_time_W, front.points[k + 1].price_of_time_W, typical_W);
    const auto point = point_at(parts, price_W, standby_W);
    if (!point) break;
    front.points.insert(front.points.begin() + static_cast<std::ptrdiff_t>(k) + 1, *point);
    finish_steps();
  }
  front.summary.status = SolveStatus::optimal;
  front.summary.solver = "fast";
  return front;
}

}  // namespace joulepath
