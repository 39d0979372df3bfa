#include "planner/bound/least_rate.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "planner/nlp/interval/range.hpp"

// Method: [Moore1966]
namespace joulepath {
namespace {

using nlp::Range;

constexpr int kMostCells = 4000;
constexpr int kWeightSteps = 12;  ///< halvings of a weight
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

struct Cell {
  const Sector* sector{};
  Range m{}, x{};
  Weights weight{1, 1};
  double low{};
  friend bool operator<(const Cell& one, const Cell& other) { return one.low > other.low; }
};

class RateSearch {
 public:
  RateSearch(const PowerForm& form, const MotionPrice& price, double tolerance)
      : form_(form), price_(price), tolerance_(tolerance), limits_(form.limits) {
    most_m_s_ = std::min(limits_.speed_m_s, price.most_m_s);
    a_ = {-limits_.deceleration_m_s2, limits_.acceleration_m_s2};
    b_ = {-limits_.yaw_acceleration_rad_s2, limits_.yaw_acceleration_rad_s2};
  }

  double find() {
    for (const Sector& sector : form_.sectors)
      if (!sector.mirrored || price_.per_rad_J != 0) add_octaves(sector);
    for (int count = 0; count < kMostCells && !cells_.empty(); ++count) {
      const Cell cell = cells_.top();
      if (cell.low >= best_ - tolerance_ || best_ < kLowest) break;
      cells_.pop();
      split(cell);
    }
    return cells_.empty() ? best_ : std::min(best_, cells_.top().low);
  }

 private:
  static constexpr double kLowest = -1e7;  ///< below it the rate counts as unbounded

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
    Square f{.c = form_.standby_W + price_.time_W - price_.per_rad_J * w,
             .ra = 2 * price_.p * v,
             .rb = -price_.spin * form_.yaw_inertia_kg_m2 * w};
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

  double speed(const Cell& cell, double m, double x) const { return cell.sector->turning ? m * x : m; }

  void push(Cell cell) {
    if (beyond(cell)) return;
    const double m = 0.5 * (cell.m.low + cell.m.high), x = 0.5 * (cell.x.low + cell.x.high);
    const Least middle = choose_weights(cell, m, x);
    if (inside(cell, m, x)) {
      const double v = speed(cell, m, x);
      best_ = std::min(best_, v > 0              ? (middle.value + cubic(v)) / v
                              : middle.value < 0 ? -kNoLimit
                                                 : kNoLimit);
    }
    cell.low = low_of(cell);
    cells_.push(cell);
  }

  /// The cubic term is interpolated, or replaced by its least value on the cell: the better of both.
  double low_of(const Cell& cell) const {
    const double below = below_interpolation(cell), of_cubic = cubic_below_interpolation(cell);
    const double least_cubic =
        std::min(cubic(speed(cell, cell.m.low, cell.x.low)), cubic(speed(cell, cell.m.high, cell.x.high)));
    double interpolated = kNoLimit, constant = kNoLimit;
    for (double cm : {cell.m.low, cell.m.high})
      for (double cx : {cell.x.low, cell.x.high}) {
        const Square f = square_at(cell, cm, cx, cell.weight);
        const double value = least_on(f, a_, b_).value;
        const double v = speed(cell, cm, cx);
        const double surely =
            value - below -
            kRounding * (form_.standby_W + std::abs(f.c) + std::abs(value) + std::abs(cubic(v)));
        const auto rate = [&](double watts) { return v > 0 ? watts / v : watts >= 0 ? kNoLimit : -kNoLimit; };
        interpolated = std::min(interpolated, rate(surely + cubic(v) - of_cubic));
        constant = std::min(constant, rate(surely + least_cubic));
        if (cell.x.low == cell.x.high) break;
      }
    return std::max(interpolated, constant);
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
  double tolerance_{};
  const Limits& limits_;
  double most_m_s_{};
  Range a_{}, b_{};
  double best_{kNoLimit};
  std::priority_queue<Cell> cells_{};
};

}  // namespace

double least_rate(const PowerForm& form, const MotionPrice& price, double tolerance) {
  return RateSearch(form, price, tolerance).find();
}

}  // namespace joulepath
