#include "diagnosis/calibration/wheel_equations.hpp"

#include <cmath>

#include "model/dynamics.hpp"

namespace joulepath::calibration {
namespace {

constexpr int kCurrentColumn = 7;

double mean_radius_m(const Geometry& geometry) {
  return 0.5 * (geometry.wheel_radius_m.left + geometry.wheel_radius_m.right);
}

double ratio_to_mean(double value, double other) {
  return value + other > 0 ? 2 * value / (value + other) : 1.0;
}

/// Contribution of 1 kg of payload to J and D, with the geometry of the robot file.
struct PayloadInertia {
  double straight_m2{}, turning_m2{};
};

PayloadInertia payload_inertia(const Robot& robot) {
  const double r = mean_radius_m(robot.geometry), l = robot.geometry.half_track_m;
  const double d_p = robot.payload_offset_or_default_m();
  return {r * r / 2, (robot.inertia.payload_yaw_inertia_m2 + d_p * d_p) * r * r / (2 * l * l)};
}

/// Wheel torque at constant speeds caused by a center of mass ahead of the axle: r/2 (-mu w^2) +/- r/(2 l) mu
/// v w.
Sided<double> known_torque_Nm(const Robot& robot, const SmoothedSample& sample) {
  const double r = mean_radius_m(robot.geometry), l = robot.geometry.half_track_m;
  const double v = 0.5 * r * (sample.speed_rad_s.left + sample.speed_rad_s.right);
  const double w = 0.5 * r / l * (sample.speed_rad_s.right - sample.speed_rad_s.left);
  const double mu = mass_properties(robot, sample.payload_kg).first_moment_kg_m;
  const double forward = -0.5 * r * mu * w * w, turning = 0.5 * r / l * mu * v * w;
  return {forward - turning, forward + turning};
}

/// Variances of noise in a sample: of q', and of the mean and half the difference of q'' (independent
/// wheels).
struct SpeedNoise {
  double slow{}, fast{};
};

SpeedNoise speed_noise(const SmoothedRun& run) {
  const double speed_variance = run.speed_noise_rad_s * run.speed_noise_rad_s;
  return {.slow = run.kernel.value_gain * speed_variance,
          .fast = 0.5 * run.kernel.derivative_gain * speed_variance};
}

using TorqueColumns = Eigen::Matrix<double, FitSums::kTorqueColumns, 1>;

/// The winding's equation; `x` is the torque's.
void add_voltage(const SmoothedSample& sample, Side side, const SideRatios& ratio, const TorqueColumns& x,
                 const SpeedNoise& noise, FitSums& sums) {
  const double back = ratio.torque_per_ampere * ratio.voltage_over_torque_constant;
  Eigen::Matrix<double, FitSums::kVoltageColumns, 1> y;
  y << x.head<5>(), sample.current_slope_A_s[side], ratio.resistance * sample.current_A[side],
      back * sample.speed_rad_s[side], sample.voltage_V[side];
  sums.voltage += y * y.transpose();
  constexpr int kSpeed = 7;
  sums.voltage(kViscous, kViscous) -= ratio.viscous * ratio.viscous * noise.slow;
  sums.voltage(kViscous, kSpeed) -= ratio.viscous * back * noise.slow;
  sums.voltage(kSpeed, kViscous) -= ratio.viscous * back * noise.slow;
  sums.voltage(kSpeed, kSpeed) -= back * back * noise.slow;
  sums.voltage(kStraightInertia, kStraightInertia) -= noise.fast;
  sums.voltage(kTurningInertia, kTurningInertia) -= noise.fast;
  sums.voltage_count += 1;
}

void add_sample(const Robot& robot, const SmoothedRun& run, const SmoothedSample& sample, Side side,
                FitSums& sums) {
  const SideRatios ratio = side_ratios(robot, side);
  const PayloadInertia payload = payload_inertia(robot);
  const double mean = 0.5 * (sample.acceleration_rad_s2.left + sample.acceleration_rad_s2.right);
  const double apart = sample.acceleration_rad_s2[side] - mean;
  const double q = sample.speed_rad_s[side], i = sample.current_A[side];
  const double sign = q > 0 ? 1.0 : -1.0;
  const double heavy = sample.payload_kg * payload.straight_m2, wide = sample.payload_kg * payload.turning_m2;

  TorqueColumns x;
  x << (side == Side::left ? sign : 0.0), (side == Side::right ? sign : 0.0), ratio.viscous * q, mean, apart,
      heavy * mean + wide * apart, known_torque_Nm(robot, sample)[side], ratio.torque_per_ampere * i;
  sums.torque += x * x.transpose();

  const auto [slow, fast] = speed_noise(run);
  sums.torque(kViscous, kViscous) -= ratio.viscous * ratio.viscous * slow;
  sums.torque(kStraightInertia, kStraightInertia) -= fast;
  sums.torque(kTurningInertia, kTurningInertia) -= fast;
  sums.torque(kPayloadFactor, kPayloadFactor) -= fast * (heavy * heavy + wide * wide);
  for (auto [column, factor] : {std::pair{kStraightInertia, heavy}, std::pair{kTurningInertia, wide}}) {
    sums.torque(kPayloadFactor, column) -= fast * factor;
    sums.torque(column, kPayloadFactor) -= fast * factor;
  }
  sums.acceleration_noise += fast;
  sums.torque_count += 1;

  if (run.has_voltage && std::isfinite(sample.voltage_V[side]))
    add_voltage(sample, side, ratio, x, {slow, fast}, sums);
}

}  // namespace

FitSums& FitSums::operator+=(const FitSums& other) {
  torque += other.torque, voltage += other.voltage;
  const double count = static_cast<double>(samples + other.samples);
  if (count > 0)
    independent_share = (independent_share * static_cast<double>(samples) +
                         other.independent_share * static_cast<double>(other.samples)) /
                        count;
  acceleration_noise += other.acceleration_noise;
  torque_count += other.torque_count, voltage_count += other.voltage_count, samples += other.samples;
  return *this;
}

FitSums& FitSums::operator-=(const FitSums& other) {
  torque -= other.torque, voltage -= other.voltage;
  acceleration_noise -= other.acceleration_noise;
  torque_count -= other.torque_count, voltage_count -= other.voltage_count, samples -= other.samples;
  return *this;
}

SideRatios side_ratios(const Robot& robot, Side side) {
  const Motor& motor = robot.motor[side];
  const Motor& other = robot.motor[side == Side::left ? Side::right : Side::left];
  return {.resistance = ratio_to_mean(motor.resistance_ohm, other.resistance_ohm),
          .torque_per_ampere = ratio_to_mean(motor.torque_per_ampere_Nm_A(), other.torque_per_ampere_Nm_A()),
          .viscous = ratio_to_mean(motor.viscous_friction_Nm_s_rad, other.viscous_friction_Nm_s_rad),
          .voltage_over_torque_constant = motor.volts_per_speed_V_s_rad() / motor.torque_per_ampere_Nm_A()};
}

FitValues nominal_values(const Robot& robot) {
  const Motor &left = robot.motor.left, &right = robot.motor.right;
  const double r = mean_radius_m(robot.geometry), l = robot.geometry.half_track_m;
  const MassProperties mass = mass_properties(robot, 0.0);
  const double axle = robot.inertia.wheel_axle_inertia_kg_m2;
  return {left.friction_torque_Nm,
          right.friction_torque_Nm,
          0.5 * (left.viscous_friction_Nm_s_rad + right.viscous_friction_Nm_s_rad),
          mass.mass_kg * r * r / 2 + axle,
          mass.yaw_inertia_kg_m2 * r * r / (2 * l * l) + axle,
          1.0,
          0.5 * (left.torque_per_ampere_Nm_A() + right.torque_per_ampere_Nm_A()),
          0.5 * (left.resistance_ohm + right.resistance_ohm)};
}

std::vector<FitSums> fit_sums(const Robot& robot, const std::vector<SmoothedRun>& runs,
                              std::size_t fewest_runs, double block_s) {
  const bool in_blocks = runs.size() < fewest_runs;
  std::vector<FitSums> units;
  for (const SmoothedRun& run : runs) {
    FitSums sums{.independent_share = run.kernel.value_gain};
    double end_s = run.samples.empty() ? 0 : run.samples.front().time_s + block_s;
    const auto close = [&] {
      if (sums.samples > 0) units.push_back(sums);
      sums = FitSums{.independent_share = run.kernel.value_gain};
    };
    for (const SmoothedSample& sample : run.samples) {
      if (in_blocks && sample.time_s >= end_s) {
        close();
        end_s = sample.time_s + block_s;
      }
      for (Side side : kSides)
        if (sample.turning[side]) add_sample(robot, run, sample, side, sums);
      sums.samples += sample.turning.left || sample.turning.right;
    }
    close();
  }
  return units;
}

}  // namespace joulepath::calibration
