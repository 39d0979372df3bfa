#include "planner/bound/least_rate.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <queue>
#include <stdexcept>

#include "planner/nlp/interval/range.hpp"

// Method: [Moore1966]
namespace joulepath {
namespace {

using nlp::Range;

constexpr int kMostCells = 4000;
constexpr int kWeightSteps = 12;  ///< halvings of a weight
constexpr int kYawRates = 50;     ///< sampled where the robot turns in place
constexpr int kOctaves = 4;       ///< of the yaw rate, at first
constexpr int kWeightRounds = 3;
constexpr double kShareOfTolerance = 0.2;  ///< that weights may lose
constexpr double kRounding = 1e-10;        ///< relative, of the terms of a sum

/// c + r.z + z.Q.z/2 in z = (a, alpha).
struct Square {
  double c{}, ra{}, rb{}, aa{}, ab{}, bb{};
  double operator()(double a, double b) const {
    return c + a * (ra + 0.5 * aa * a + ab * b) + b * (rb + 0.5 * bb * b);
  }
};

struct Least {
  double value{kNoLimit}, a{}, b{};
};

double clamped_root(double slope, double curvature, double low, double high) {
  if (curvature > 0) return std::clamp(-slope / curvature, low, high);
  return slope > 0 ? low : high;
}

/// Least value of a convex square over a box; exact.
Least least_on(const Square& f, const Range& a, const Range& b) {
  Least best;
  const auto look = [&](double x, double y) {
    if (const double value = f(x, y); value < best.value) best = {value, x, y};
  };
  const double det = f.aa * f.bb - f.ab * f.ab;
  if (det > 1e-12 * f.aa * f.bb) {
    const double x = (-f.ra * f.bb + f.rb * f.ab) / det, y = (-f.rb * f.aa + f.ra * f.ab) / det;
    if (x >= a.low && x <= a.high && y >= b.low && y <= b.high) return {f(x, y), x, y};
  }
  for (double x : {a.low, a.high}) look(x, clamped_root(f.rb + f.ab * x, f.bb, b.low, b.high));
  for (double y : {b.low, b.high}) look(clamped_root(f.ra + f.ab * y, f.aa, a.low, a.high), y);
  return best;
}

using Weights = Sided<double>;

/// One value for each price per radian.
using Values = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostHeadingPrices, 1>;

struct Cell {
  const Sector* sector{};
  Range m{}, x{};
  Weights weight{1, 1};
  Values low{};
};

class RateSearch {
 public:
  RateSearch(const PowerForm& form, const MotionPrice& price, const std::vector<double>& per_rad_J,
             double tolerance)
      : form_(form),
        price_(price),
        per_rad_J_(Eigen::Map<const Eigen::ArrayXd>(per_rad_J.data(), std::ssize(per_rad_J))),
        tolerance_(tolerance),
        limits_(form.limits),
        best_(Values::Constant(per_rad_J_.size(), kNoLimit)) {
    most_m_s_ = std::min(limits_.speed_m_s, price.most_m_s);
    a_ = {-limits_.deceleration_m_s2, limits_.acceleration_m_s2};
    b_ = {-limits_.yaw_acceleration_rad_s2, limits_.yaw_acceleration_rad_s2};
  }

  std::vector<double> find() {
    const bool any_turn = (per_rad_J_ != 0).any();
    for (const Sector& sector : form_.sectors)
      if (!sector.mirrored || any_turn) add_octaves(sector);
    Values low = Values::Constant(best_.size(), kNoLimit);
    for (int splits = 0; !open_.empty();) {
      const std::size_t k = open_.top().second;
      open_.pop();
      const double gain = gain_of(cells_[k]);
      if (!open_.empty() && gain < open_.top().first) {
        open_.emplace(gain, k);
      } else if (gain > tolerance_ && splits < kMostCells) {
        split(Cell(cells_[k])), ++splits;
      } else {
        low = low.min(cells_[k].low);
      }
    }
    low = low.min(best_);
    return {low.begin(), low.end()};
  }

  /// Least power of turning in place per yaw rate, at samples of it.
  double turning_price() {
    double price_J = kNoLimit;
    for (const Sector& sector : form_.sectors)
      for (int k = 1; k <= kYawRates && sector.turning && sector.x_high == 0; ++k) {
        Cell cell{.sector = &sector};
        const double m = most_m(sector) * k / kYawRates;
        price_J = std::min(price_J, choose_weights(cell, m, 0).value * form_.half_track_m / m);
      }
    return price_J;
  }

 private:
  static constexpr double kLowest = -1e7;  ///< below it a rate counts as unbounded

  double gain_of(const Cell& cell) const {
    return (best_ < kLowest || cell.low == kNoLimit).select(-kNoLimit, best_ - cell.low).maxCoeff();
  }

  double most_m(const Sector& sector) const {
    const double spin = limits_.yaw_rate_rad_s * form_.half_track_m;
    return sector.turning ? spin : sector.x_low == 1 ? std::min(most_m_s_, spin) : most_m_s_;
  }

  /// The first cells. A turning robot has its speed in the product of both coordinates.
  void add_octaves(const Sector& sector) {
    double high = most_m(sector);
    for (int k = 0; k < kOctaves && sector.turning && sector.x_high > 0; ++k, high *= 0.5)
      push({.sector = &sector,
            .m = {0.5 * high, high},
            .x = {sector.x_low, std::min(1.0, 2 * most_m_s_ / high)}});
    push({.sector = &sector, .m = {0, high}, .x = {sector.x_low, sector.x_high}});
  }

  /// Whether every motion of the cell is beyond a limit.
  bool beyond(const Cell& cell) const {
    const double l = form_.half_track_m, m = cell.m.low, x = cell.x.low;
    const double v = cell.sector->turning ? m * x : m, w = (cell.sector->turning ? m : m * x) / l;
    return v > most_m_s_ || w > limits_.yaw_rate_rad_s || v * w > limits_.lateral_acceleration_m_s2;
  }

  Square square_at(const Cell& cell, double m, double x, const Weights& weight) const {
    const Sector& sector = *cell.sector;
    const double v = sector.turning ? m * x : m;
    const double w = sector.turn * (sector.turning ? m : m * x) / form_.half_track_m;
    Square f{.c = form_.standby_W + price_.time_W,
             .ra = 2 * price_.p * v,
             .rb = -price_.credit.spin * form_.yaw_inertia_kg_m2 * w};
    if (sector.turning)
      f.ra += price_.credit.inner, f.rb -= price_.credit.inner * form_.half_track_m * sector.turn;
    for (Side side : kSides) {
      const WheelForm& k = sector.wheel[side];
      const double i = k.i0 + m * (k.b0 + k.b1 * x) + m * m * (k.d0 + x * (k.d1 + x * k.d2));
      const double r = weight[side] * k.resistance_ohm,
                   e = weight[side] * k.volts_per_speed * m * (k.s0 + k.s1 * x);
      f.c += i * (r * i + e);
      const double slope = 2 * r * i + e;
      f.ra += slope * k.of_a, f.rb += slope * k.of_alpha;
      f.aa += 2 * r * k.of_a * k.of_a, f.ab += 2 * r * k.of_a * k.of_alpha,
          f.bb += 2 * r * k.of_alpha * k.of_alpha;
    }
    return f;
  }

  /// Power of both wheels at the least of the square.
  Sided<double> powers(const Cell& cell, double m, double x, const Least& at) const {
    return map_sides(cell.sector->wheel, [&](Side, const WheelForm& k) {
      const double i = k.i0 + m * (k.b0 + k.b1 * x) + m * m * (k.d0 + x * (k.d1 + x * k.d2)) + k.of_a * at.a +
                       k.of_alpha * at.b;
      return i * (k.resistance_ohm * i + k.volts_per_speed * m * (k.s0 + k.s1 * x));
    });
  }

  /// Weights that give about the greatest least: any weights are valid. Those of the parent if they do; else
  /// one weight for both wheels, then each in turn. A weight inside its range makes the wheel's power vanish.
  Least choose_weights(Cell& cell, double m, double x) const {
    const double eta = form_.regeneration;
    Least at;
    Sided<double> power{};
    const double enough = kShareOfTolerance * tolerance_ * speed(cell, m, x);
    const auto settled = [&] {
      const auto lost = [&](double watts, double weight) {
        return watts * ((watts > 0 ? 1.0 : eta) - weight);
      };
      const Weights& weight = cell.weight;
      return (form_.shared ? lost(power.left + power.right, weight.left)
                           : lost(power.left, weight.left) + lost(power.right, weight.right)) <= enough;
    };
    const auto set = [&](bool left, bool right, double value) {
      if (left) cell.weight.left = value;
      if (right) cell.weight.right = value;
      at = least_on(square_at(cell, m, x, cell.weight), a_, b_);
      power = powers(cell, m, x, at);
      return (left ? power.left : 0.0) + (right ? power.right : 0.0);
    };
    const auto balance = [&](bool left, bool right) {
      if (set(left, right, 1.0) >= 0 || set(left, right, eta) <= 0) return;
      double low = eta, high = 1;
      for (int n = 0; n < kWeightSteps; ++n) {
        const double middle = 0.5 * (low + high);
        (set(left, right, middle) > 0 ? low : high) = middle;
      }
    };
    set(false, false, 0);
    if (settled()) return at;
    balance(true, true);
    if (form_.shared) return at;
    for (int round = 0; round < kWeightRounds && !settled(); ++round)
      balance(true, false), balance(false, true);
    return at;
  }

  double cubic(double v) const { return price_.p_slope * v * v * v; }

  /// By how much p' v^3 may lie below its bilinear interpolation on the cell.
  double cubic_below_interpolation(const Cell& cell) const {
    const Range m = cell.m, x = cell.x;
    const double dm = m.high - m.low, dx = x.high - x.low;
    const Range mm =
        cell.sector->turning ? 6.0 * (price_.p_slope * (m * (x * (x * x)))) : 6.0 * (price_.p_slope * m);
    const Range xx = cell.sector->turning ? 6.0 * (price_.p_slope * (m * (m * (m * x)))) : Range(0);
    return 0.125 * (dm * dm * std::max(0.0, mm.high) + dx * dx * std::max(0.0, xx.high));
  }

  /// By how much the other terms may.
  double below_interpolation(const Cell& cell) const {
    const Sector& sector = *cell.sector;
    const Range m = cell.m, x = cell.x;
    const double dm = m.high - m.low, dx = x.high - x.low;
    Range mm{0, 0}, xx{0, 0};
    for (Side side : kSides) {
      const WheelForm& k = sector.wheel[side];
      const double r = cell.weight[side] * k.resistance_ohm, e = cell.weight[side] * k.volts_per_speed;
      const Range beta = Range(k.b0) + k.b1 * x, delta = Range(k.d0) + x * (Range(k.d1) + k.d2 * x);
      const Range i = Range(k.i0) + m * beta + m * (m * delta) + k.of_a * a_ + k.of_alpha * b_;
      const Range i_m = beta + 2.0 * (m * delta), i_mm = 2.0 * delta;
      const Range i_x = m * (Range(k.b1) + m * (Range(k.d1) + 2 * k.d2 * x)), i_xx = 2 * k.d2 * (m * m);
      const Range s_m = Range(k.s0) + k.s1 * x, s = m * s_m, s_x = k.s1 * m;
      mm += 2 * r * (i_m * i_m + i * i_mm) + e * (2.0 * (s_m * i_m) + s * i_mm);
      xx += 2 * r * (i_x * i_x + i * i_xx) + e * (2.0 * (s_x * i_x) + s * i_xx);
    }
    return 0.125 * (dm * dm * std::max(0.0, mm.high) + dx * dx * std::max(0.0, xx.high));
  }

  static double speed(const Cell& cell, double m, double x) { return cell.sector->turning ? m * x : m; }

  /// What the heading pays per second.
  Values heading_W(const Cell& cell, double m, double x) const {
    return per_rad_J_ * (cell.sector->turn * (cell.sector->turning ? m : m * x) / form_.half_track_m);
  }

  void push(Cell cell) {
    if (beyond(cell)) return;
    const double m = 0.5 * (cell.m.low + cell.m.high), x = 0.5 * (cell.x.low + cell.x.high);
    const Least middle = choose_weights(cell, m, x);
    if (inside(cell, m, x)) {
      const double v = speed(cell, m, x);
      const Values watts = middle.value + cubic(v) - heading_W(cell, m, x);
      best_ = best_.min(rates(watts, v, watts < 0));
    }
    cell.low = low_of(cell);
    open_.emplace(gain_of(cell), cells_.size());
    cells_.push_back(cell);
  }

  /// Per meter; standing still, without a bound where it pays.
  template <class Pays>
  static Values rates(const Values& watts, double v, const Pays& pays) {
    if (v > 0) return watts / v;
    return pays.select(Values::Constant(watts.size(), -kNoLimit), Values::Constant(watts.size(), kNoLimit));
  }

  /// The cubic term is interpolated, or replaced by its least value on the cell: the better of both.
  Values low_of(const Cell& cell) const {
    const double below = below_interpolation(cell), of_cubic = cubic_below_interpolation(cell);
    const double least_cubic =
        std::min(cubic(speed(cell, cell.m.low, cell.x.low)), cubic(speed(cell, cell.m.high, cell.x.high)));
    Values interpolated = Values::Constant(best_.size(), kNoLimit), constant = interpolated;
    for (double cm : {cell.m.low, cell.m.high})
      for (double cx : {cell.x.low, cell.x.high}) {
        const Square f = square_at(cell, cm, cx, cell.weight);
        const double value = least_on(f, a_, b_).value;
        const double v = speed(cell, cm, cx);
        const Values pay = heading_W(cell, cm, cx);
        const Values surely =
            value - below - pay -
            kRounding * (form_.standby_W + std::abs(f.c) + std::abs(value) + std::abs(cubic(v)) + pay.abs());
        interpolated = interpolated.min(rates(surely + cubic(v) - of_cubic, v, surely < of_cubic));
        constant = constant.min(rates(surely + least_cubic, v, surely < -least_cubic));
        if (cell.x.low == cell.x.high) break;
      }
    return interpolated.max(constant);
  }

  bool inside(const Cell& cell, double m, double x) const {
    Cell point = cell;
    point.m = m, point.x = x;
    return !beyond(point);
  }

  void split(const Cell& cell) {
    Cell one = cell, other = cell;
    const double of_m = (cell.m.high - cell.m.low) / cell.m.high,
                 of_x = (cell.x.high - cell.x.low) / (cell.sector->turning ? cell.x.high : 1.0);
    if (of_m >= of_x) {
      one.m.high = other.m.low = 0.5 * (cell.m.low + cell.m.high);
    } else {
      one.x.high = other.x.low = 0.5 * (cell.x.low + cell.x.high);
    }
    push(one), push(other);
  }

  const PowerForm& form_;
  const MotionPrice& price_;
  Values per_rad_J_{};
  double tolerance_{};
  const Limits& limits_;
  double most_m_s_{};
  Range a_{}, b_{};
  Values best_{};
  std::vector<Cell> cells_{};
  std::priority_queue<std::pair<double, std::size_t>> open_{};  ///< by how much a cell may lie below the best
};

}  // namespace

double least_rate(const PowerForm& form, const MotionPrice& price, double tolerance) {
  return least_rates(form, price, {0.0}, tolerance).front();
}

double turning_price(const PowerForm& form, const TurnCredit& credit, double time_W) {
  return RateSearch(form, {.credit = credit, .time_W = time_W}, {}, 0).turning_price();
}

std::vector<double> least_rates(const PowerForm& form, const MotionPrice& price,
                                const std::vector<double>& per_rad_J, double tolerance) {
  if (per_rad_J.size() > kMostHeadingPrices) throw std::invalid_argument("least_rates: too many prices");
  return RateSearch(form, price, per_rad_J, tolerance).find();
}

}  // namespace joulepath
