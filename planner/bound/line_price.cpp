#include "planner/bound/line_price.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace joulepath {
namespace {

constexpr int kAccelerations = 40;  ///< sampled between 0 and the limit
constexpr double kSlowest = 0.004;  ///< first node, of the greatest speed
constexpr int kSlowNodes = 24;      ///< up to a tenth of it, in equal ratios
constexpr int kFastNodes = 32;
constexpr double kLongest_m = 0.07;  ///< of the pieces between nodes
constexpr double kShortest_m = 0.0125;
constexpr double kShortestShare = 0.15;  ///< of the way from rest, near rest

/// Power (W) along a straight line, driving forward.
class Straight {
 public:
  Straight(const PowerForm& form, double time_W) : form_(form), time_W_(time_W) {
    for (const Sector& sector : form.sectors)
      if (!sector.turning && sector.travel > 0 && sector.turn == 0) sector_ = &sector;
  }

  double power_W(double u, double a) const {
    double sum = 0, each = 0;
    for (Side side : kSides) {
      const WheelForm& k = sector_->wheel[side];
      const double i = k.i0 + u * (k.b0 + u * k.d0) + k.of_a * a,
                   p = i * (k.resistance_ohm * i + k.volts_per_speed * u * k.s0);
      sum += p, each += counted(p);
    }
    return form_.standby_W + time_W_ + (form_.shared ? counted(sum) : each);
  }

  /// The ramp's slope phi' at a speed and its acceleration, before the peak (sign +1) or after it (-1).
  struct Ramp {
    double slope{}, a{};
  };
  Ramp ramp(double u, double e, double sign) const {
    const double most = sign > 0 ? form_.limits.acceleration_m_s2 : form_.limits.deceleration_m_s2;
    Ramp best{-kNoLimit, 0};
    const auto look = [&](double a) {
      if (const double value = (e * u - power_W(u, sign * a)) / a; value > best.slope) best = {value, a};
    };
    for (int k = 1; k <= kAccelerations; ++k) look(most * k / kAccelerations);
    if (sign < 0)
      for (Side side : kSides)  // where the current of a wheel vanishes
        if (const WheelForm& k = sector_->wheel[side]; k.of_a != 0)
          if (const double a = (k.i0 + u * (k.b0 + u * k.d0)) / k.of_a; a > 0.01 * most && a < most) look(a);
    return {sign * best.slope, best.a};
  }

  double cheapest_m_s() const {
    double best = form_.limits.speed_m_s, least = kNoLimit;
    for (int k = 1; k <= 1000; ++k) {
      const double u = form_.limits.speed_m_s * k / 1000;
      if (const double rate = power_W(u, 0) / u; rate < least) least = rate, best = u;
    }
    return best;
  }

 private:
  double counted(double p) const { return p >= 0 ? p : form_.regeneration * p; }

  const PowerForm& form_;
  double time_W_{};
  const Sector* sector_{};
};

/// Both ramps up to the peak, from rest: lengths and slopes at the speeds' nodes.
struct Ramps {
  std::vector<double> u{0}, up_m{0}, down_m{0}, up{0}, down{0};
  double length_m() const { return up_m.back() + down_m.back(); }
};

Ramps ramps(const Straight& straight, double e, double top_m_s, double most_m_s) {
  std::vector<double> nodes;
  for (int k = 0; k < kSlowNodes; ++k)
    nodes.push_back(most_m_s * kSlowest * std::pow(0.1 / kSlowest, 1.0 * k / kSlowNodes));
  for (int k = 0; k <= kFastNodes; ++k) nodes.push_back(most_m_s * (0.1 + 0.9 * k / kFastNodes));
  Ramps all;
  double of_up = 0, of_down = 0;  // meters per speed, at the last node
  const auto add_node = [&](double u) {
    const Straight::Ramp up = straight.ramp(u, e, 1), down = straight.ramp(u, e, -1);
    if (all.u.size() > 1 && up.slope > down.slope) return false;
    const double du = u - all.u.back();
    all.up_m.push_back(all.up_m.back() + 0.5 * du * (of_up + u / up.a));
    all.down_m.push_back(all.down_m.back() + 0.5 * du * (of_down + u / down.a));
    of_up = u / up.a, of_down = u / down.a;
    all.u.push_back(u), all.up.push_back(up.slope), all.down.push_back(down.slope);
    return true;
  };
  const auto add = [&](double u) {
    const double from = all.u.back(), step = u - from;
    const double ds = u / std::min(straight.ramp(u, e, 1).a, straight.ramp(u, e, -1).a) * step;
    const int parts = static_cast<int>(std::clamp(std::ceil(ds / kLongest_m), 1.0, 40.0));
    for (int k = 1; k <= parts; ++k)
      if (!add_node(k == parts ? u : from + step * k / parts)) return false;
    return true;
  };
  for (double u : nodes) {
    u = std::min(u, top_m_s);
    if (!add(u)) {
      double low = all.u.back(), high = u;
      for (int k = 0; k < 20; ++k) {
        const double middle = 0.5 * (low + high);
        (straight.ramp(middle, e, 1).slope > straight.ramp(middle, e, -1).slope ? high : low) = middle;
      }
      if (low > all.u.back()) add(low);
      break;
    }
    if (u >= top_m_s) break;
  }
  return all;
}

/// The ramps that fit a length at the least price of a meter.
Ramps fitting_ramps(const PowerForm& form, double length_m, double time_W) {
  const Straight straight(form, time_W);
  const double most = form.limits.speed_m_s, cheapest = straight.cheapest_m_s();
  const double e0 = straight.power_W(cheapest, 0) / cheapest;
  Ramps fit = ramps(straight, e0, cheapest, most);
  if (fit.length_m() <= length_m) return fit;
  double low = e0, high = 100 * e0;
  for (int k = 0; k < 30; ++k) {
    const double e = std::sqrt(low * high);
    fit = ramps(straight, e, most, most);
    (fit.length_m() > length_m ? low : high) = e;
  }
  return ramps(straight, high, most, most);
}

/// The nodes of a ramp that are neither too close nor missing at its ends.
std::vector<std::size_t> apart(const std::vector<double>& s_m) {
  std::vector<std::size_t> kept{0, 1};
  for (std::size_t k = 2; k + 1 < s_m.size(); ++k)
    if (s_m[k] - s_m[kept.back()] >= std::min(kShortest_m, kShortestShare * s_m[k])) kept.push_back(k);
  if (kept.back() != s_m.size() - 1) kept.push_back(s_m.size() - 1);
  return kept;
}

}  // namespace

LinePrice line_price(const PowerForm& form, double length_m, double time_W) {
  const Ramps fit = fitting_ramps(form, length_m, time_W);
  const double scale = std::min(1.0, length_m / fit.length_m());
  const std::size_t last = fit.u.size() - 1;
  const auto node_p = [&](const std::vector<double>& slope, std::size_t k) {
    if (k == last) return (fit.up[last] + fit.down[last]) / (4 * fit.u[last]);
    return slope[std::max<std::size_t>(k, 1)] / (2 * fit.u[std::max<std::size_t>(k, 1)]);
  };
  LinePrice line;
  const auto add = [&](double s_m, double p) { line.s_m.push_back(s_m), line.p.push_back(p); };
  for (std::size_t k : apart(fit.up_m)) add(scale * fit.up_m[k], node_p(fit.up, k));
  line.peak = line.s_m.size() - 1;
  std::vector<std::size_t> back = apart(fit.down_m);
  for (std::size_t j = back.size(); j-- > 0;)
    add(length_m - scale * fit.down_m[back[j]], node_p(fit.down, back[j]));
  return line;
}

double long_line_m(const PowerForm& form, double time_W) {
  return fitting_ramps(form, kNoLimit, time_W).length_m();
}

MotionPrice price_on(const LinePrice& line, std::size_t piece, bool at_end, const PowerForm& form) {
  const double ds = line.s_m[piece + 1] - line.s_m[piece];
  const double reach = piece < line.peak ? 2 * form.limits.acceleration_m_s2 * line.s_m[piece + 1]
                       : piece > line.peak
                           ? 2 * form.limits.deceleration_m_s2 * (line.length_m() - line.s_m[piece])
                           : kNoLimit;
  return {.p = line.p[piece + (at_end ? 1 : 0)],
          .p_slope = ds > 0 ? (line.p[piece + 1] - line.p[piece]) / ds : 0.0,
          .most_m_s = std::sqrt(reach)};
}

namespace {

constexpr double kTolerance = 0.006;  ///< J/m
constexpr double kRoughly = 0.2;      ///< J/m, to choose by
constexpr std::size_t kPiecesOfACredit = 4;
constexpr double kPieceTolerance_J = 3e-4;  ///< of a short piece

/// Integral of the least rate over one piece. The rate is concave along it: the mean of its ends is a bound.
double piece_J(const PowerForm& form, const LinePrice& line, std::size_t piece, const TurnCredit& credit,
               double time_W) {
  const double ds = line.s_m[piece + 1] - line.s_m[piece];
  if (!(ds > 0)) return 0;
  double sum = 0;
  for (bool at_end : {false, true}) {
    MotionPrice price = price_on(line, piece, at_end, form);
    price.credit = credit, price.time_W = time_W;
    sum += 0.5 * ds * least_rate(form, price, std::max(kTolerance, kPieceTolerance_J / ds));
  }
  return sum;
}

/// Credits to choose from, of rotation and (in its largest yaw momentum over the half track) of an inner
/// wheel that rolls backward.
constexpr std::array<TurnCredit, 8> kCredits{
    {{1.2, 0.45}, {1.2, 0.22}, {1, 0.45}, {1, 0.22}, {1, 0}, {0.4, 0.22}, {0.4, 0}, {0, 0}}};

/// The energy of rotation is priced as it is at the peak, above it only while the robot speeds up, below it
/// only while it slows down.
bool suits(const TurnCredit& credit, std::size_t piece, std::size_t peak) {
  return piece == peak ? credit.spin == 1 : piece < peak ? credit.spin >= 1 : credit.spin <= 1;
}

}  // namespace

std::vector<TurnCredit> falling_credits(const PowerForm& form, const LinePrice& line, double time_W,
                                        const std::vector<double>& before_J,
                                        const std::vector<double>& after_J) {
  const double momentum = form.yaw_inertia_kg_m2 * form.limits.yaw_rate_rad_s / form.half_track_m;
  std::array<TurnCredit, kCredits.size()> credits = kCredits;
  for (TurnCredit& credit : credits) credit.inner *= momentum;
  const std::size_t pieces = line.s_m.size() - 1;
  std::array<double, kCredits.size()> best{};
  std::vector<std::array<std::size_t, kCredits.size()>> before;  // of each run
  std::vector<std::size_t> runs{0};                              // of pieces with one credit: their begins
  while (runs.back() < pieces) {
    const std::size_t from = runs.back(), peak = line.peak;
    const std::size_t to = from < peak    ? std::min(peak, from + kPiecesOfACredit)
                           : from == peak ? peak + 1
                                          : std::min(pieces, from + kPiecesOfACredit);
    const double ds = line.s_m[to] - line.s_m[from];
    std::array<double, kCredits.size()> next;
    before.emplace_back();
    for (std::size_t j = 0; j < credits.size(); ++j) {
      next[j] = -kNoLimit;
      if (!suits(credits[j], from, peak)) continue;
      std::size_t& last = before.back()[j] = j;
      for (std::size_t i = 0; i < credits.size(); ++i)
        if (credits[i].spin >= credits[j].spin && credits[i].inner >= credits[j].inner &&
            best[i] > best[last])
          last = i;
      next[j] = best[last];
      if (!(ds > 0)) continue;
      MotionPrice price = price_on(line, (from + to) / 2, false, form);
      price.credit = credits[j], price.time_W = time_W;
      for (const double rate : least_rates(form, price, from <= peak ? before_J : after_J, kRoughly))
        next[j] += ds * rate;
    }
    best = next;
    runs.push_back(to);
  }
  std::vector<TurnCredit> chosen(pieces);
  std::size_t j = static_cast<std::size_t>(std::max_element(best.begin(), best.end()) - best.begin());
  for (std::size_t k = before.size(); k-- > 0; j = before[k][j])
    std::fill(chosen.begin() + std::ptrdiff_t(runs[k]), chosen.begin() + std::ptrdiff_t(runs[k + 1]),
              credits[j]);
  return chosen;
}

LineBound line_bound(const PowerForm& form, double length_m, double time_W) {
  const LinePrice line = line_price(form, length_m, time_W);
  const std::vector<TurnCredit> credits = falling_credits(form, line, time_W, {0.0}, {0.0});
  LineBound bound{.length_m = length_m};
  const double per_m_J = least_rate(
      form, {.p = line.p[line.peak], .credit = credits[line.peak], .time_W = time_W}, 0.5 * kTolerance);
  if (!(per_m_J >= 0)) return bound;
  bound.per_m_J = per_m_J;
  for (std::size_t k = 0; k < credits.size(); ++k)
    bound.energy_J += piece_J(form, line, k, credits[k], time_W);
  return bound;
}

}  // namespace joulepath
