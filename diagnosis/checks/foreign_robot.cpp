#include "diagnosis/checks/foreign_robot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnosis/checks/small_fit.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// A constant as the runs have it over the file's, in logarithms.
struct LogRatio {
  ForeignConstant constant{};
  double ratio{}, least{}, most{};  ///< most likely, and at the ends of what is sure
  double box{};                     ///< that effects and calibration errors may use up

  [[nodiscard]] bool is_foreign() const { return least > box || most < -box; }
};

bool add_ratio(std::string name, std::string unit, double file, double value, double error, double box,
               std::vector<LogRatio>& ratios) {
  const double low = value - kSureSigmas * error, high = value + kSureSigmas * error;
  if (!(low > 0) || !(file > 0)) return false;
  ratios.push_back({{std::move(name), std::move(unit), file, value},
                    std::log(value / file),
                    std::log(low / file),
                    std::log(high / file),
                    std::log(box)});
  return true;
}

/// Whether the channel is there and varies: a stuck one tells no constant.
bool varies(const RunSignals& run, const Eigen::VectorXd& channel) {
  return run.size() > 0 && channel.size() == run.size() && channel.maxCoeff() > channel.minCoeff() + 1e-9;
}

bool measures_windings(const RunSignals& run) {
  return std::ranges::all_of(kSides, [&](Side side) {
    return varies(run, run.motor_voltage_V[side]) && varies(run, run.motor_current_A[side]);
  });
}

/// V = R i + Kv n w of both wheels; with a third term, a driver's drop, which has the current's sign.
template <int N>
bool add_windings(const Robot& robot, const std::vector<RunSignals>& runs, std::vector<LogRatio>& ratios) {
  SmallFit<N> fit;
  for (const RunSignals& run : runs)
    for (Side side : kSides)
      for (Eigen::Index j = 0; measures_windings(run) && j < run.size(); ++j)
        if (run.conducting[side][static_cast<std::size_t>(j)]) {
          const Eigen::Vector3d row(run.motor_current_A[side][j], run.wheel_speed_rad_s[side][j],
                                    run.current_direction[side][j]);
          fit.add(row.head<N>(), run.motor_voltage_V[side][j]);
        }
  std::array<double, 2> value{}, error{};
  const Motor& motor = robot.motor.left;
  return fit.solve(value, error) &&
         add_ratio("winding resistance", "ohm", motor.resistance_ohm, value[0], error[0], kMostMeasuredFactor,
                   ratios) &&
         add_ratio("voltage per wheel speed", "V s/rad", motor.volts_per_speed_V_s_rad(), value[1], error[1],
                   kMostScale, ratios);
}

/// Torque of both motors = (m r^2 + 2 J) w' + friction + viscous losses, the payload's part taken off; the
/// jerk's column takes up a delay. The torque per ampere differs from the file's as the voltage per speed
/// does. What is told is the inertia at the wheels with the runs' payload, not the mass: that takes the
/// wheels' radius.
bool add_inertia(const Robot& robot, const std::vector<RunSignals>& runs, std::vector<LogRatio>& ratios) {
  SmallFit<4> fit;
  double payload = 0, weight = 0;
  const double radius_m = 0.5 * (robot.geometry.wheel_radius_m.left + robot.geometry.wheel_radius_m.right),
               torque_Nm_A = robot.motor.left.torque_per_ampere_Nm_A() * std::exp(ratios.back().ratio);
  for (const RunSignals& run : runs)
    for (Eigen::Index j = 0; run.payload_known && measures_windings(run) && j < run.size(); ++j) {
      const auto mean = [j](const Sided<Eigen::VectorXd>& of) { return 0.5 * (of.left[j] + of.right[j]); };
      const double speed = mean(run.wheel_speed_rad_s), rate = mean(run.wheel_acceleration_rad_s2),
                   jerk = run.wheel_jerk_rad_s3.left.size() > 0 ? mean(run.wheel_jerk_rad_s3) : 0.0;
      const auto k = static_cast<std::size_t>(j);
      const bool forward = run.wheel_speed_rad_s.left[j] > 0;
      if (!run.turning.left[k] || !run.turning.right[k]) continue;
      if (forward != (run.wheel_speed_rad_s.right[j] > 0)) continue;
      const double torque_Nm = torque_Nm_A * (run.motor_current_A.left[j] + run.motor_current_A.right[j]);
      fit.add({rate, forward ? 1.0 : -1.0, speed, jerk},
              torque_Nm - run.payload_kg[j] * radius_m * radius_m * rate);
      payload += run.payload_kg[j] * rate * rate, weight += rate * rate;
    }
  std::array<double, 1> value{}, error{};
  const double file_kg_m2 =
      robot.total_mass_kg(0.0) * radius_m * radius_m + 2 * robot.inertia.wheel_axle_inertia_kg_m2;
  if (!fit.solve(value, error) || !add_ratio("inertia that the wheels accelerate", "kg m^2", file_kg_m2,
                                             value[0], error[0], kMostInertia, ratios))
    return false;
  const double payload_kg_m2 = payload / weight * radius_m * radius_m;
  ratios.back().constant.in_file += payload_kg_m2, ratios.back().constant.in_runs += payload_kg_m2;
  return true;
}

/// Whether one factor on voltages, currents or wheel speeds brings all constants into their boxes.
bool is_scaled_channel(const std::vector<LogRatio>& ratios) {
  const Eigen::Vector3d found(ratios[0].ratio, ratios[1].ratio, ratios[2].ratio),
      box(ratios[0].box, ratios[1].box, ratios[2].box);
  const std::array<Eigen::Vector3d, 3> scaled{Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(-1, 0, 1),
                                              Eigen::Vector3d(0, -1, -2)};
  return std::ranges::any_of(scaled, [&](const Eigen::Vector3d& by) {
    const Eigen::Vector3d left = found - found.dot(by) / by.squaredNorm() * by;
    return (left.array().abs() <= box.array()).all();
  });
}

/// Constants that differ from the file's by more than effects can; nothing where the runs do not determine
/// them. `N`: terms of the winding's law.
template <int N>
std::optional<std::vector<ForeignConstant>> foreign_by(const Robot& robot,
                                                       const std::vector<RunSignals>& runs,
                                                       bool may_be_scaled) {
  std::vector<LogRatio> ratios;
  if (!add_windings<N>(robot, runs, ratios) || !add_inertia(robot, runs, ratios)) return std::nullopt;
  std::vector<ForeignConstant> foreign;
  if (may_be_scaled && is_scaled_channel(ratios)) return foreign;
  for (const LogRatio& one : ratios)
    if (one.is_foreign()) foreign.push_back(one.constant);
  return foreign;
}

}  // namespace

std::vector<ForeignConstant> foreign_constants(const Robot& robot, const std::vector<RunSignals>& runs,
                                               bool may_be_scaled) {
  std::vector<ForeignConstant> foreign =
      foreign_by<2>(robot, runs, may_be_scaled).value_or(std::vector<ForeignConstant>{});
  if (foreign.empty()) return foreign;
  // What a driver's drop explains is no other robot's winding.
  return foreign_by<3>(robot, runs, may_be_scaled).value_or(foreign);
}

}  // namespace joulepath
