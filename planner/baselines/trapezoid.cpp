#include "planner/baselines/trapezoid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/baselines/least_rate.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"

namespace joulepath {
namespace {

double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

}  // namespace

double most_acceleration(const ProfileRequest& request) {
  const Limits& limits = request.limits;
  return finite_or(is_turn(request.piece) ? limits.yaw_acceleration_rad_s2 : limits.acceleration_m_s2,
                   kUnlimited);
}

double most_deceleration(const ProfileRequest& request) {
  const Limits& limits = request.limits;
  return finite_or(is_turn(request.piece) ? limits.yaw_acceleration_rad_s2 : limits.deceleration_m_s2,
                   kUnlimited);
}

TrapezoidFamily::TrapezoidFamily(const ProfileRequest& request) : request_(&request), local_(request) {}

const LocalLimits::Grid& TrapezoidFamily::grid(double curve_share) const {
  if (grid_share_ != curve_share) grid_ = local_.grid(curve_share);
  grid_share_ = curve_share;
  return grid_;
}

std::vector<double> TrapezoidFamily::squares_on(const LocalLimits::Grid& grid,
                                                const TrapezoidSettings& settings) const {
  const nlp::Problem& problem = local_.problem();
  const double start = problem.b_start, end = problem.b_end, length = grid.s.back();
  const double up = 2 * settings.acceleration, down = 2 * settings.deceleration;
  std::vector<double> ceiling;
  // A start faster than the cruise is braked off, an end faster than it is run up to.
  for (double s : grid.s)
    ceiling.push_back(std::max({settings.rate * settings.rate, start - down * s, end - up * (length - s)}));
  return local_.below(grid, std::move(ceiling), settings.acceleration, settings.deceleration);
}

std::optional<std::vector<double>> TrapezoidFamily::squares(const TrapezoidSettings& settings) const {
  std::vector<double> b = squares_on(grid(settings.curve_share), settings);
  if (!local_.passes(b)) return std::nullopt;
  return b;
}

double TrapezoidFamily::duration_s(const std::vector<double>& b) const {
  return nlp::duration_of(local_.problem(), b);
}

double TrapezoidFamily::energy_J(const std::vector<double>& b) const {
  constexpr double kTolerance = 2e-5;
  const nlp::Problem& problem = local_.problem();
  double sum_J = 0;
  for (std::size_t k = 0; k < problem.segment_count(); ++k) {
    const nlp::Interval<double> interval = nlp::plain_interval(problem.segments[k], b[k], b[k + 1]);
    for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i) {
      const nlp::ActiveRow& row = problem.rows[i];
      const double value = nlp::evaluate_row(problem, row, interval);
      if (value > row.bounds.high + kTolerance * std::abs(row.bounds.high) ||
          value < row.bounds.low - kTolerance * std::abs(row.bounds.low))
        return kNoLimit;
    }
    sum_J += nlp::kept_energy_J(interval);
  }
  return sum_J;
}

double TrapezoidFamily::least_duration_s() const {
  const nlp::RateEnvelope envelope = nlp::rate_envelope(local_.problem());
  return envelope.blocked ? kNoLimit : duration_s(envelope.fastest);
}

std::optional<double> TrapezoidFamily::rate_for(double acceleration, double deceleration, double curve_share,
                                                double duration_s, double tolerance) const {
  const LocalLimits::Grid& grid = this->grid(curve_share);
  const nlp::Problem& problem = local_.problem();
  const auto excess_s = [&](double rate) {
    return this->duration_s(squares_on(grid, {rate, acceleration, deceleration, curve_share})) - duration_s;
  };
  const double high = std::sqrt(std::min(*std::max_element(grid.cap.begin(), grid.cap.end()),
                                         std::max(problem.b_start, problem.b_end) +
                                             2 * std::max(acceleration, deceleration) * problem.s.back()));
  // Twice over: an exact deadline, met to rounding, is met.
  const auto fastest = squares({high, acceleration, deceleration, curve_share});
  if (!fastest) return std::nullopt;
  const double least_s = this->duration_s(*fastest);
  if (least_s > duration_s * (1 + 1e-9)) return std::nullopt;
  if (least_s > duration_s) return high;
  constexpr int kTries = 12;
  double low = std::min(high, problem.s.back() / duration_s);
  for (int i = 0; i < kTries && !(excess_s(low) > 0); ++i) low *= 0.1;
  return excess_s(low) > 0 ? least_rate(excess_s, low, high, tolerance) : low;
}

Profile TrapezoidFamily::profile(const TrapezoidSettings& settings) const {
  const nlp::Problem& problem = local_.problem();
  const double up = 2 * settings.acceleration, down = 2 * settings.deceleration;
  const double cruise = settings.rate * settings.rate, length = problem.s.back();
  LocalLimits::Grid fine = grid(settings.curve_share);
  for (double corner : {(cruise - problem.b_start) / up, length - (cruise - problem.b_end) / down,
                        (problem.b_end - problem.b_start + down * length) / (up + down)})
    fine.insert(corner);
  return profile_from_squares(fine.s, squares_on(fine, settings));
}

std::map<std::string, double> TrapezoidFamily::parameters(const TrapezoidSettings& settings) const {
  if (is_turn(request_->piece))
    return {{"yaw_rate_rad_s", settings.rate},
            {"yaw_acceleration_rad_s2", settings.acceleration},
            {"yaw_deceleration_rad_s2", settings.deceleration}};
  std::map<std::string, double> found{{"speed_m_s", settings.rate},
                                      {"acceleration_m_s2", settings.acceleration},
                                      {"deceleration_m_s2", settings.deceleration}};
  if (settings.curve_share < 1) found["yaw_acceleration_share"] = settings.curve_share;
  return found;
}

}  // namespace joulepath
