#include "diagnosis/prediction/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/prediction/contact_creep.hpp"
#include "diagnosis/prediction/held_turn.hpp"
#include "diagnosis/prediction/region_edge.hpp"
#include "diagnosis/signals/friction_direction.hpp"
#include "diagnosis/signals/site.hpp"
#include "model/channel_delay.hpp"
#include "model/mean_power.hpp"
#include "model/operating_point.hpp"

namespace joulepath {
namespace {

/// Separates effects of instruments from effects of the robot, which belong to the plant.
struct SplitModel {
  Plant plant{};
  std::vector<Effect> instruments{};
};

SplitModel split_model(const ModelPoint& point) {
  SplitModel split{.plant = make_plant(point.robot, point.effects)};
  split.plant.payload_factor *= point.payload_factor;
  split.plant.creep_m_s_N += point.contact_creep_m_s_N;
  const auto collect = [&](const std::vector<EffectSetting>& settings) {
    for (const EffectSetting& setting : settings) {
      const EffectDescription* description = find_effect(setting.name);
      if (description && description->info.stage == Stage::instrument)
        split.instruments.push_back(make_effect(setting));
    }
  };
  collect(point.robot.effects);
  collect(point.effects);
  return split;
}

/// The voltage drop of a driver changes sign with the current. Near zero current the predicted sign is
/// uncertain, so the sign of the measured current is used where it exists.
void blur_driver_drop(double drop_V, const RunSignals& signals, Side side, Eigen::Index j,
                      WheelState<double>& wheel) {
  if (drop_V == 0) return;
  const double hard = wheel.current_A > 0 ? 1.0 : wheel.current_A < 0 ? -1.0 : 0.0;
  const double change_V = drop_V * (signals.current_sign(side, j, wheel.current_A) - hard);
  wheel.voltage_V += change_V;
  wheel.power_W += change_V * wheel.current_A;
}

struct Resizer {
  Eigen::Index n;
  void operator()(Eigen::VectorXd& v) const { v = Eigen::VectorXd::Zero(n); }
  void operator()(Sided<Eigen::VectorXd>& v) const { (*this)(v.left), (*this)(v.right); }
};

void distort(const std::vector<Effect>& instruments, double channel_delay_s, const RunSignals& signals,
             Prediction& prediction) {
  if (instruments.empty() && channel_delay_s == 0) return;
  Trajectory log;
  const auto copy = [](const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  log.time_s = copy(signals.time_s);
  for (Side side : kSides) {
    log.motor_current_A[side] = copy(prediction.current_A[side]);
    log.motor_voltage_V[side] = copy(prediction.voltage_V[side]);
  }
  distort_log(instruments, log);
  if (channel_delay_s != 0) delay_motor_channels(log, channel_delay_s);
  for (Side side : kSides)
    for (Eigen::Index j = 0; j < signals.size(); ++j) {
      double &current_A = prediction.current_A[side][j], &voltage_V = prediction.voltage_V[side][j];
      prediction.power_W[side][j] -= current_A * voltage_V;
      current_A = log.motor_current_A[side][static_cast<std::size_t>(j)];
      voltage_V = log.motor_voltage_V[side][static_cast<std::size_t>(j)];
      prediction.power_W[side][j] += current_A * voltage_V;
    }
}

double gain_of(const std::vector<Effect>& instruments, Side side) {
  double gain = 1.0;
  for (const Effect& instrument : instruments)
    std::visit(
        [&](const auto& effect) {
          if constexpr (requires { effect.current_reading(side); }) gain *= effect.current_reading(side).gain;
        },
        instrument);
  return gain;
}

Sided<Eigen::VectorXd> reading_resistance_ohm(const SplitModel& split, const RunSignals& signals) {
  Sided<Eigen::VectorXd> ohm;
  const Eigen::VectorXd factor = signals.time_of_day_s.unaryExpr(
      [&](double time_of_day_s) { return split.plant.resistance_factor(time_of_day_s); });
  for (Side side : kSides)
    ohm[side] = factor * (split.plant.robot.motor[side].resistance_ohm / gain_of(split.instruments, side));
  return ohm;
}

Prediction empty_prediction(Eigen::Index n) {
  Prediction out;
  const Resizer resize{n};
  resize(out.current_A), resize(out.voltage_V), resize(out.power_W), resize(out.power_change_W);
  resize(out.battery_power_W), resize(out.battery_voltage_V), resize(out.yaw_rate_rad_s);
  resize(out.heading_rad), resize(out.x_m), resize(out.y_m);
  return out;
}

/// How far the body has lagged behind its wheels since the run's start.
struct Slip {
  double heading_rad{}, x_m{}, y_m{};

  void add(double along_m, double turn_rad, double course_rad) {
    heading_rad += turn_rad;
    x_m += along_m * std::cos(course_rad);
    y_m += along_m * std::sin(course_rad);
  }
};

void write_electrics(const Plant& plant, const RunSignals& signals, Eigen::Index j,
                     Sided<WheelState<double>> state, const Sided<WheelChange>& change, Prediction& out) {
  const Robot& robot = plant.robot;
  for (Side side : kSides) {
    blur_driver_drop(plant.driver_voltage_drop_V, signals, side, j, state[side]);
    out.current_A[side][j] = state[side].current_A;
    out.voltage_V[side][j] = state[side].voltage_V;
    const Eigen::VectorXd& logged_W = signals.motor_covariance_W[side];
    out.power_W[side][j] =
        state[side].power_W + (logged_W.size() > 0 ? logged_W[j] : change[side].product_W());
    out.power_change_W[side][j] = change[side].power_W;
  }
  out.battery_power_W[j] = supply_W(signals, robot.power, out, j) + robot.power.standby_W;
  if (signals.battery_current_A.size() > 0)
    out.battery_voltage_V[j] = robot.battery.open_circuit_voltage_V -
                               robot.battery.internal_resistance_ohm * signals.battery_current_A[j];
}

void write_pose(const Geometry& geometry, const RunSignals& signals, Eigen::Index j, const Slip& slip,
                Prediction& out) {
  const Sided<double>& r = geometry.wheel_radius_m;
  const auto rolled = [&](const Sided<Eigen::VectorXd>& angle) {
    return 0.5 * (r.left * angle.left[j] + r.right * angle.right[j]);
  };
  out.heading_rad[j] =
      (r.right * signals.wheel_angle_rad.right[j] - r.left * signals.wheel_angle_rad.left[j]) /
          (2 * geometry.half_track_m) -
      slip.heading_rad;
  out.x_m[j] = rolled(signals.wheel_along_x_rad) - slip.x_m;
  out.y_m[j] = rolled(signals.wheel_along_y_rad) - slip.y_m;
}

/// Calls `visit(j, site, motion)` for the samples of a run in their order, and advances the effects' memory
/// by the motion that `visit` returns.
template <class Visit>
void drive(const Plant& plant, const RunSignals& signals, const Visit& visit) {
  const Geometry& geometry = plant.robot.geometry;
  EffectMemory memory{};
  for (Eigen::Index j = 0; j < signals.size(); ++j) {
    const BodyMotion<double> rolled = signals.rolled_motion(geometry, j);
    const Site site = site_at(signals, j, geometry, rolled, memory);
    const BodyMotion<double> motion = visit(j, site, rolled);
    advance_memory(plant,
                   caster_speed_m_s(geometry, motion.speed_m_s, motion.yaw_rate_rad_s) * signals.period_s,
                   site.course, memory);
  }
}

Sided<WheelState<double>> state_at(const Plant& plant, const RunSignals& signals,
                                   const BodyMotion<double>& motion, const Site& site) {
  return operating_point_over_kernel(plant, motion, site, motion.speed_m_s * signals.kernel_sigma_s);
}

/// Where a plant has no creep: nothing.
BodyLag creep_of(const Plant& plant, const RunSignals& signals) {
  if (plant.creep_m_s_N == 0) return {};
  std::vector<Sided<double>> force_N;
  force_N.reserve(static_cast<std::size_t>(signals.size()));
  drive(plant, signals, [&](Eigen::Index, const Site& site, const BodyMotion<double>& motion) {
    const auto [left, right] = state_at(plant, signals, motion, site);
    force_N.push_back({left.contact_force_N, right.contact_force_N});
    return motion;
  });
  return contact_creep(plant, signals, force_N);
}

void add_where_known(const Eigen::VectorXd& deviation, Eigen::VectorXd& channel) {
  if (deviation.size() > 0) channel += deviation;
}

/// A current that deviates takes the winding's voltage along where the simulator gives none.
void add_motor_deviation(const RunSignals& signals, Side side, Prediction& out) {
  const Eigen::VectorXd &current_A = signals.deviation.current_A[side],
                        &voltage_V = signals.deviation.voltage_V[side];
  if (voltage_V.size() == 0 && current_A.size() > 0)
    out.voltage_V[side] += out.reading_resistance_ohm[side].cwiseProduct(current_A);
  add_where_known(voltage_V, out.voltage_V[side]);
  add_where_known(current_A, out.current_A[side]);
  add_where_known(signals.deviation.power_W[side], out.power_W[side]);
}

/// Where the simulator gives no power of its battery, the supply gives what its motors take.
void add_deviation(const RunSignals& signals, const PowerSupply& supply, Prediction& out) {
  const DeviationOf<Eigen::VectorXd>& deviation = signals.deviation;
  if (deviation.turning.left.size() == 0) return;
  const Prediction model = out;
  for (Side side : kSides) add_motor_deviation(signals, side, out);
  add_where_known(deviation.battery_power_W, out.battery_power_W);
  for (Eigen::Index j = 0; deviation.battery_power_W.size() == 0 && j < signals.size(); ++j)
    out.battery_power_W[j] += supply_W(signals, supply, out, j) - supply_W(signals, supply, model, j);
  add_where_known(deviation.battery_voltage_V, out.battery_voltage_V);
  add_where_known(deviation.yaw_rate_rad_s, out.yaw_rate_rad_s);
  add_where_known(deviation.heading_rad, out.heading_rad);
  add_where_known(deviation.x_m, out.x_m);
  add_where_known(deviation.y_m, out.y_m);
}

}  // namespace

double supply_W(const RunSignals& signals, const PowerSupply& supply, const Prediction& prediction,
                Eigen::Index j) {
  const auto of_means_W = [&](const Sided<double>& mean_W) {
    return mean_supply_power_W(supply, mean_W,
                               {prediction.power_change_W.left[j], prediction.power_change_W.right[j]});
  };
  const double mean_W = of_means_W({prediction.power_W.left[j], prediction.power_W.right[j]});
  if (signals.expected_beyond_mean_W.size() > 0) return mean_W + signals.expected_beyond_mean_W[j];
  const SupplyAccount& logged = signals.motors_at_supply;
  return logged.empty() ? mean_W : mean_W + logged.supply_W(supply, j) - of_means_W(logged.mean_W(j));
}

Prediction predict(const RunSignals& signals, const ModelPoint& point) {
  const SplitModel split = split_model(point);
  const Plant& plant = split.plant;
  Prediction out = empty_prediction(signals.size());
  BodyLag lag = creep_of(plant, signals);
  lag += point.swing;
  Slip slip;
  HeldTurn turn(plant, point.held_moment_Nm);
  drive(plant, signals, [&](Eigen::Index j, const Site& site, const BodyMotion<double>& rolled) {
    const BodyMotion<double> motion = lag.empty() ? rolled : lag.body_motion(rolled, j);
    Sided<WheelState<double>> state = state_at(plant, signals, motion, site);
    if (!lag.empty()) {
      lag.spin_wheels(plant, site, j, state);
      slip.add(lag.along.value[j] * signals.period_s, lag.turn.value[j] * signals.period_s,
               site.pose.heading_rad);
    }
    turn.load(signals, motion, site, state);
    write_electrics(plant, signals, j, state, change_at(plant, signals, j, motion, site), out);
    out.yaw_rate_rad_s[j] = motion.yaw_rate_rad_s;
    write_pose(plant.robot.geometry, signals, j, slip, out);
    return motion;
  });
  distort(split.instruments, point.channel_delay_s, signals, out);
  out.reading_resistance_ohm = reading_resistance_ohm(split, signals);
  add_deviation(signals, plant.robot.power, out);
  return out;
}

}  // namespace joulepath
