#include "planner/baselines/trapezoid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/baselines/finish.hpp"
#include "planner/nlp/grid.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kNodes = 300;

/// What yaw acceleration leaves at constant speed: |slope of turn| b <= limit.
double steady_cap(const ProfileRequest& request, const PathRates& rates) {
  const double slope = std::abs(rates.turn_slope);
  return slope > 0 ? request.limits.yaw_acceleration_rad_s2 / slope : kNoLimit;
}

double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

}  // namespace

TrapezoidFamily::TrapezoidFamily(const ProfileRequest& request) : request_(&request) {
  const PathMotion motion = path_motion(request);
  problem_ = nlp::transcribe(request, motion, nlp::make_grid(motion, request, kNodes), {}, nullptr);
  cap_.assign(problem_.node_count(), 0.0);
  for (std::size_t k = 0; k < cap_.size(); ++k) cap_[k] = std::min(problem_.cap[k].squared, 1e6);
  for (std::size_t k = 0; k < problem_.segment_count(); ++k)
    for (const nlp::SegmentPoint& point : problem_.segments[k].limit_points) {
      const double cap = steady_cap(request, point.rates);
      cap_[k] = std::min(cap_[k], cap);
      cap_[k + 1] = std::min(cap_[k + 1], cap);
    }
  const Limits& limits = request.limits;
  const bool turn = is_turn(request.piece);
  most_acceleration_ =
      finite_or(turn ? limits.yaw_acceleration_rad_s2 : limits.acceleration_m_s2, kUnlimited);
  most_deceleration_ =
      finite_or(turn ? limits.yaw_acceleration_rad_s2 : limits.deceleration_m_s2, kUnlimited);
}

std::vector<double> TrapezoidFamily::squares_on(const std::vector<double>& s, const std::vector<double>& cap,
                                                const TrapezoidSettings& settings) const {
  const double up = 2 * settings.acceleration, down = 2 * settings.deceleration;
  const double start = problem_.b_start, end = problem_.b_end, length = s.back();
  std::vector<double> b(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) {
    // A start faster than the cruise is braked off, an end faster than it is run up to.
    const double cruise =
        std::max({settings.rate * settings.rate, start - down * s[k], end - up * (length - s[k])});
    b[k] = std::min(cap[k], cruise);
  }
  b.front() = std::min(b.front(), start);
  b.back() = std::min(b.back(), end);
  for (std::size_t k = 1; k < s.size(); ++k) b[k] = std::min(b[k], b[k - 1] + up * (s[k] - s[k - 1]));
  for (std::size_t k = s.size() - 1; k-- > 0;) b[k] = std::min(b[k], b[k + 1] + down * (s[k + 1] - s[k]));
  return b;
}

std::optional<std::vector<double>> TrapezoidFamily::squares(const TrapezoidSettings& settings) const {
  std::vector<double> b = squares_on(problem_.s, cap_, settings);
  constexpr double kRounding = 1e-9;
  if (b.front() < problem_.b_start - kRounding || b.back() < problem_.b_end - kRounding) return std::nullopt;
  for (std::size_t k = 1; k + 1 < b.size(); ++k)
    if (!(b[k] > 0)) return std::nullopt;
  return b;
}

double TrapezoidFamily::duration_s(const std::vector<double>& b) const {
  return nlp::duration_of(problem_, b);
}

double TrapezoidFamily::energy_J(const std::vector<double>& b) const {
  constexpr double kTolerance = 2e-5;
  const double weight = 1 - request_->plant.robot.power.regeneration_efficiency;
  double sum_J = 0;
  for (std::size_t k = 0; k < problem_.segment_count(); ++k) {
    const nlp::Interval<double> interval = nlp::plain_interval(problem_.segments[k], b[k], b[k + 1]);
    for (std::size_t i = problem_.first_row[k]; i < problem_.first_row[k + 1]; ++i) {
      const nlp::ActiveRow& row = problem_.rows[i];
      const double value = nlp::evaluate_row(problem_, row, interval);
      if (value > row.bounds.high + kTolerance * std::abs(row.bounds.high) ||
          value < row.bounds.low - kTolerance * std::abs(row.bounds.low))
        return kNoLimit;
    }
    for (double energy_J : nlp::Energy::both(interval)) sum_J += energy_J + weight * std::max(0.0, -energy_J);
  }
  return sum_J;
}

std::optional<double> TrapezoidFamily::rate_for(double acceleration, double deceleration,
                                                double duration_s) const {
  const auto slow = [&](double rate) {
    const auto b = squares({rate, acceleration, deceleration});
    return !b || this->duration_s(*b) > duration_s;
  };
  double high = std::sqrt(std::min(*std::max_element(cap_.begin(), cap_.end()),
                                   std::max(problem_.b_start, problem_.b_end) +
                                       2 * std::max(acceleration, deceleration) * problem_.s.back()));
  // Twice over: an exact deadline, met to rounding, is met.
  const auto fastest = squares({high, acceleration, deceleration});
  if (!fastest) return std::nullopt;
  const double least_s = this->duration_s(*fastest);
  if (least_s > duration_s * (1 + 1e-9)) return std::nullopt;
  double low = 0.0;
  for (int i = 0; i < 60 && high - low > 1e-13 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (slow(middle) ? low : high) = middle;
  }
  return high;
}

Profile TrapezoidFamily::profile(const TrapezoidSettings& settings) const {
  const double up = 2 * settings.acceleration, down = 2 * settings.deceleration;
  const double cruise = settings.rate * settings.rate, length = problem_.s.back();
  const std::array<double, 3> corners{(cruise - problem_.b_start) / up,
                                      length - (cruise - problem_.b_end) / down,
                                      (problem_.b_end - problem_.b_start + down * length) / (up + down)};
  std::vector<double> s = problem_.s, cap = cap_;
  for (double corner : corners) {
    const auto after = std::upper_bound(s.begin(), s.end(), corner);
    if (after == s.begin() || after == s.end()) continue;
    const auto k = after - s.begin();
    const double before_s = *(after - 1), gap = *after - before_s;
    if (corner - before_s < 1e-6 * gap || *after - corner < 1e-6 * gap) continue;
    const double share = (corner - before_s) / gap;
    const double cap_here =
        (1 - share) * cap[static_cast<std::size_t>(k - 1)] + share * cap[static_cast<std::size_t>(k)];
    s.insert(s.begin() + k, corner);
    cap.insert(cap.begin() + k, cap_here);
  }
  return profile_from_squares(s, squares_on(s, cap, settings));
}

std::map<std::string, double> TrapezoidFamily::parameters(const TrapezoidSettings& settings) const {
  if (is_turn(request_->piece))
    return {{"yaw_rate_rad_s", settings.rate},
            {"yaw_acceleration_rad_s2", settings.acceleration},
            {"yaw_deceleration_rad_s2", settings.deceleration}};
  return {{"speed_m_s", settings.rate},
          {"acceleration_m_s2", settings.acceleration},
          {"deceleration_m_s2", settings.deceleration}};
}

namespace {

/// Makes the executable profile take its time exactly: the corners' nodes changed it a little.
BaselineResult finish_trapezoid(const ProfileRequest& request, const TrapezoidFamily& family,
                                const char* name, TrapezoidSettings settings, double duration_s) {
  const auto excess_s = [&](double rate) {
    return family.profile({rate, settings.acceleration, settings.deceleration}).time_s.back() - duration_s;
  };
  double low = settings.rate * (1 - 1e-2), high = settings.rate * (1 + 1e-2);
  if (excess_s(low) > 0 && excess_s(high) < 0) {
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (excess_s(middle) > 0 ? low : high) = middle;
    }
    settings.rate = high;
  }
  return finish_baseline(request, name, family.profile(settings), duration_s, family.parameters(settings));
}

}  // namespace

BaselineResult trapezoid_max_acceleration(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "trapezoid_max_acceleration";
  const TrapezoidFamily family(request);
  const double up = family.most_acceleration(), down = family.most_deceleration();
  const std::optional<double> rate = family.rate_for(up, down, duration_s);
  if (!rate) return no_baseline(kName, "cannot make the time with the local speed limits");
  return finish_trapezoid(request, family, kName, {*rate, up, down}, duration_s);
}

BaselineResult trapezoid_best_tuned(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "trapezoid_best_tuned";
  const TrapezoidFamily family(request);
  struct Best {
    double energy_J{kNoLimit};
    double up{}, down{};  // natural logarithms of the shares of the largest accelerations
  } best;
  const auto settings_at = [&](double up, double down) -> std::optional<TrapezoidSettings> {
    const double acceleration = family.most_acceleration() * std::exp(std::min(0.0, up));
    const double deceleration = family.most_deceleration() * std::exp(std::min(0.0, down));
    const auto rate = family.rate_for(acceleration, deceleration, duration_s);
    if (!rate) return std::nullopt;
    return TrapezoidSettings{*rate, acceleration, deceleration};
  };
  const auto look = [&](double up, double down) {
    const auto settings = settings_at(up, down);
    if (!settings) return false;
    const double energy_J = family.energy_J(*family.squares(*settings));
    if (!(energy_J < best.energy_J)) return false;
    best = {energy_J, std::min(0.0, up), std::min(0.0, down)};
    return true;
  };
  for (double up = 0; up > -4.0; up -= 0.5)
    for (double down = 0; down > -4.0; down -= 0.5) look(up, down);
  if (!std::isfinite(best.energy_J))
    return no_baseline(kName, "no trapezoid makes the time within the limits");
  for (double step = 0.25; step > 1e-3;) {
    const Best at = best;
    bool better = false;
    for (const auto& [du, dd] :
         {std::pair{1., 0.}, {-1., 0.}, {0., 1.}, {0., -1.}, {1., 1.}, {-1., -1.}, {1., -1.}, {-1., 1.}})
      better |= look(at.up + step * du, at.down + step * dd);
    if (!better) step /= 2;
  }
  return finish_trapezoid(request, family, kName, *settings_at(best.up, best.down), duration_s);
}

}  // namespace joulepath
