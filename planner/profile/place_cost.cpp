#include "planner/profile/place_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/kinematics.hpp"
#include "model/operating_point.hpp"
#include "model/power.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/nlp/transcription/rate_cap.hpp"

namespace joulepath {
namespace {

using nlp::Range;

constexpr double kLongAfter_s = 1e9;  ///< every winding has its final temperature

/// Cuts the range of x to -size <= line(x) <= size.
void cut(Range& range, const Line& line, double size) {
  if (!std::isfinite(size)) return;
  if (line.slope == 0) {
    if (std::abs(line.at_0) > size) range.high = -kNoLimit;
    return;
  }
  const double x = (-size - line.at_0) / line.slope, y = (size - line.at_0) / line.slope;
  range.low = std::max(range.low, std::min(x, y));
  range.high = std::min(range.high, std::max(x, y));
}

/// Both real roots of q(x) = 0; not numbers if there are none.
std::array<double, 2> roots(const Quadratic& q) {
  const double d = std::sqrt(q.c1 * q.c1 - 4 * q.c2 * q.c0), t = -0.5 * (q.c1 + std::copysign(d, q.c1));
  return {t / q.c2, q.c0 / t};
}

/// Cuts the range of x to q(x) <= size; q bends upward.
void cut_above(Range& range, Quadratic q, double size) {
  if (!std::isfinite(size) || !(q.c2 > 0)) return;
  q.c0 -= size;
  const auto [x, y] = roots(q);
  if (std::isnan(x) || std::isnan(y)) {
    range.high = -kNoLimit;
    return;
  }
  range.low = std::max(range.low, std::min(x, y));
  range.high = std::min(range.high, std::max(x, y));
}

Quadratic sum(double x_weight, const Quadratic& x, double y_weight, const Quadratic& y) {
  return {x_weight * x.c0 + y_weight * y.c0, x_weight * x.c1 + y_weight * y.c1,
          x_weight * x.c2 + y_weight * y.c2};
}

/// Least value of a convex, piecewise quadratic cost over a range: at its ends, at a kink, or at the
/// stationary point of a piece.
class LeastCost {
 public:
  LeastCost(const PowerSupply& supply, const Sided<WheelPower>& wheels, double q, Range range)
      : supply_(supply), wheels_(wheels), q_(q), range_(range) {}

  double find() {
    if (!(range_.low <= range_.high)) return kNoLimit;
    look(std::isfinite(range_.low) ? range_.low : std::min(0.0, range_.high));
    look(std::isfinite(range_.high) ? range_.high : std::max(0.0, range_.low));
    for (Side side : kSides) look(wheels_[side].kink);
    for (const Quadratic* left : {&wheels_.left.below, &wheels_.left.above}) {
      for (const Quadratic* right : {&wheels_.right.below, &wheels_.right.above}) {
        look_at_pieces(*left, *right);
        if (!wheels_.right.bent()) break;
      }
      if (!wheels_.left.bent()) break;
    }
    return least_;
  }

 private:
  void look_at_pieces(const Quadratic& left, const Quadratic& right) {
    const double eta = supply_.regeneration_efficiency;
    look_stationary(1, left, 1, right);
    if (eta == 1) return;
    look_stationary(eta, left, eta, right);
    if (supply_.sharing == PowerSharing::bus) {
      for (double x : roots(sum(1, left, 1, right))) look(x);
      return;
    }
    look_stationary(1, left, eta, right);
    look_stationary(eta, left, 1, right);
    for (double x : roots(left)) look(x);
    for (double x : roots(right)) look(x);
  }

  void look_stationary(double left_weight, const Quadratic& left, double right_weight,
                       const Quadratic& right) {
    const Quadratic s = sum(left_weight, left, right_weight, right);
    if (s.c2 > 0) look(std::clamp((q_ - s.c1) / (2 * s.c2), range_.low, range_.high));
  }

  void look(double a) {
    if (!(a >= range_.low && a <= range_.high) || !std::isfinite(a)) return;
    const double supply_W = supply_power_W(supply_, {wheels_.left(a), wheels_.right(a)});
    least_ = std::min(least_, supply_W - q_ * a);
  }

  const PowerSupply& supply_;
  const Sided<WheelPower>& wheels_;
  double q_{};
  Range range_{};
  double least_{kNoLimit};
};

/// A wheel with gear loss and driver drop: the current is piecewise linear in the acceleration, with a kink
/// where the load changes its sign.
void bend(WheelPower& wheel, const Plant& plant, Side side, const Site& site, const Line& speed_rad_s) {
  const Motor& motor = plant.robot.motor[side];
  const double resistance_ohm =
      plant.resistance_factor(site.time_of_day_s) * motor.resistance_ohm + plant.heat_price_ohm[side];
  const double loss = plant.torque_loss_fraction * site.wheel_direction[side];
  const Line load_A = wheel.current_A;
  const auto piece = [&](double sign) {
    const Line current_A = (1 / (1 - sign * loss)) * load_A;
    const Line drop_V{sign * plant.driver_voltage_drop_V, 0};
    return (resistance_ohm * current_A + motor.volts_per_speed_V_s_rad() * speed_rad_s + drop_V) * current_A;
  };
  const double above = load_A.slope > 0 ? 1 : load_A.slope < 0 ? -1 : load_A.at_0 > 0 ? -1 : 1;
  wheel.below = piece(-above);
  wheel.above = piece(above);
  wheel.kink = load_A.slope == 0 ? std::numeric_limits<double>::max() : -load_A.at_0 / load_A.slope;
}

}  // namespace

CostModel::CostModel(const ProfileRequest& asked, const PathMotion& along, double seconds_W)
    : request(asked), motion(along), time_W(seconds_W), unbent(along.plant()), affine_fit(unbent) {
  bent = unbent.torque_loss_fraction != 0 || unbent.driver_voltage_drop_V != 0;
  unbent.torque_loss_fraction = unbent.driver_voltage_drop_V = 0;
  const double start_s = motion.time_of_day_start_s(), end_s = start_s + kLongAfter_s;
  const double cold = unbent.resistance_factor(start_s), hot = unbent.resistance_factor(end_s);
  warms_up = cold != hot;
  least_resistance = cold <= hot ? start_s : end_s;
}

PlaceCost::PlaceCost(const CostModel& model, double s, double time_s) : model_(&model) {
  const PathMotion::Place place = model.motion.laws(s, time_s);
  rates_ = place.rates;
  planned_ = site_ = place.site;
  site_.time_of_day_s = model.least_resistance;
  affine_ = !model.bent && model.affine_fit.at(rates_, site_, wheel_);
  const ProfileRequest& request = model.request;
  const Limits& limits = request.limits;
  const bool along = rates_.along != 0;
  const double up = along ? limits.acceleration_m_s2 : limits.yaw_acceleration_rad_s2;
  const double down = along ? limits.deceleration_m_s2 : limits.yaw_acceleration_rad_s2;
  const double left = model.motion.length() - s;
  fastest_ = std::sqrt(std::min({nlp::rate_cap_squared(request, rates_, s),
                                 request.start_rate * request.start_rate + 2 * up * s,
                                 request.end_rate * request.end_rate + 2 * down * left}));
}

double PlaceCost::at(double u, double a) const {
  const Plant& plant = model_->motion.plant();
  const Sided<WheelState<double>> wheels =
      operating_point(plant, PathMotion::body_motion(rates_, u, a), planned_);
  return model_->time_W + planned_power_W(plant, wheels);
}

double PlaceCost::least(double u, double q) const {
  Sided<WheelPower> wheels = wheels_at(u);
  const Range range = accelerations(u, wheels);
  for (const Side side : kSides)
    if (const double price_ohm = model_->unbent.heat_price_ohm[side]; price_ohm > 0 && !wheels[side].bent())
      wheels[side].below =
          sum(1, wheels[side].below, price_ohm, wheels[side].current_A * wheels[side].current_A);
  return model_->time_W + LeastCost(model_->unbent.robot.power, wheels, q, range).find();
}

double PlaceCost::largest_square() const {
  const auto allowed = [&](double u) {
    const Range range = accelerations(u);
    return range.low <= range.high;
  };
  double low = 0, high = fastest_;
  if (!std::isfinite(high) || allowed(high)) return high * high;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (allowed(middle) ? low : high) = middle;
  }
  return high * high;
}

Sided<WheelPower> PlaceCost::wheels_at(double u) const {
  if (affine_)
    return map_sides(wheel_, [&](Side, const nlp::AffineWheel& wheel) {
      const auto line = [&](const nlp::Affine& x) {
        return Line{x.constant + u * (x.of_u + u * x.of_b), x.of_a};
      };
      WheelPower result{.current_A = line(wheel.current_A),
                        .voltage_V = line(wheel.voltage_V),
                        .force_N = line(wheel.force_N)};
      result.below = result.voltage_V * result.current_A;
      return result;
    });
  const auto state = [&](double a) {
    return operating_point(model_->unbent, PathMotion::body_motion(rates_, u, a), site_);
  };
  const Sided<WheelState<double>> steady = state(0), pushed = state(1);
  return map_sides(steady, [&](Side side, const WheelState<double>& wheel) {
    const auto line = [&](double WheelState<double>::*member) {
      return Line{wheel.*member, pushed[side].*member - wheel.*member};
    };
    WheelPower result{.current_A = line(&WheelState<double>::current_A),
                      .voltage_V = line(&WheelState<double>::voltage_V),
                      .force_N = line(&WheelState<double>::contact_force_N)};
    result.below = result.voltage_V * result.current_A;
    if (model_->bent)
      bend(result, model_->motion.plant(), side, site_, line(&WheelState<double>::speed_rad_s));
    return result;
  });
}

/// A wheel's voltage V and the battery's sag stay below the open-circuit voltage U. Where V is above U/2 that
/// is V (U - V) >= R_i P, with P at least the sum of the motors' power and standby.
void PlaceCost::cut_by_sag(Range& range, const Sided<WheelPower>& wheels, Side side, double open_V) const {
  const Robot& robot = model_->unbent.robot;
  const double R = robot.battery.internal_resistance_ohm;
  for (const double sign : {1.0, -1.0}) {
    const Line V = sign * wheels[side].voltage_V;
    const Quadratic power = sum(R, wheels.left.below, R, wheels.right.below);
    const Quadratic own = V * V;
    const Quadratic excess{own.c0 - open_V * V.at_0 + power.c0 + R * robot.power.standby_W,
                           own.c1 - open_V * V.slope + power.c1, own.c2 + power.c2};
    if (!(excess.c2 > 0) || V.slope == 0) continue;
    const auto [x, y] = roots(excess);
    if (std::isnan(x) || std::isnan(y)) continue;
    const double end = V.slope > 0 ? std::max(x, y) : std::min(x, y);
    if (V(end) < 0.5 * open_V) continue;
    (V.slope > 0 ? range.high : range.low) =
        V.slope > 0 ? std::min(range.high, end) : std::max(range.low, end);
  }
}

/// The limits that are linear in the acceleration of the path.
Range PlaceCost::accelerations(double u, const Sided<WheelPower>& wheels) const {
  const Limits& limits = model_->request.limits;
  const double b = u * u;
  Range range{-kNoLimit, kNoLimit};
  if (rates_.along != 0) range = {-limits.deceleration_m_s2, limits.acceleration_m_s2};
  cut(range, {rates_.turn_slope * b, rates_.turn}, limits.yaw_acceleration_rad_s2);
  if (std::isfinite(limits.wheel_acceleration_rad_s2)) {
    const Geometry& geometry = model_->unbent.robot.geometry;
    const Sided<double> steady = wheel_speeds_rad_s(geometry, 0.0, rates_.turn_slope * b);
    const Sided<double> slope = wheel_speeds_rad_s(geometry, rates_.along, rates_.turn);
    for (Side side : kSides) cut(range, {steady[side], slope[side]}, limits.wheel_acceleration_rad_s2);
  }
  cut_by_ratings(range, wheels);
  return range;
}

void PlaceCost::cut_by_ratings(Range& range, const Sided<WheelPower>& wheels) const {
  const Limits& limits = model_->request.limits;
  const Robot& robot = model_->unbent.robot;
  const double mass_kg = robot.total_mass_kg(model_->unbent.payload_kg(site_.payload_kg));
  for (Side side : kSides) {
    const WheelPower& wheel = wheels[side];
    cut(range, wheel.force_N, limits.traction_coefficient * 0.5 * mass_kg * kGravity_m_s2);
    if (wheel.bent()) continue;
    cut(range, wheel.current_A, robot.motor[side].max_current_A);
    if (!model_->warms_up) cut(range, wheel.voltage_V, robot.motor[side].max_voltage_V);
    cut_above(range, wheel.below, limits.motor_power_W);
  }
  if (wheels.left.bent() || wheels.right.bent()) return;
  if (!model_->warms_up && std::isfinite(limits.battery_voltage_V))
    for (Side side : kSides) cut_by_sag(range, wheels, side, limits.battery_voltage_V);
  if (!std::isfinite(limits.battery_power_W)) return;
  const double most_W = limits.battery_power_W - robot.power.standby_W;
  const double eta = robot.power.regeneration_efficiency;
  const Quadratic &left = wheels.left.below, &right = wheels.right.below;
  cut_above(range, sum(1, left, 1, right), most_W);
  if (robot.power.sharing == PowerSharing::bus) return;
  cut_above(range, sum(eta, left, 1, right), most_W);
  cut_above(range, sum(1, left, eta, right), most_W);
}

}  // namespace joulepath
