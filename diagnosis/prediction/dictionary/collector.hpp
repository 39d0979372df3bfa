#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/prediction/dictionary.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "model/mean_power.hpp"

namespace joulepath {

/// A hat function: 1 at `center`, 0 at a distance of `width`.
inline double hat(double x, double center, double width) {
  return std::max(0.0, 1.0 - std::abs(x - center) / width);
}

/// Elapsed share of the dataset's time of day at a sample, 0 to 1.
inline double day_share(const DictionaryLayout& layout, const RunSignals& signals, Eigen::Index j) {
  return (signals.time_of_day_s[j] - layout.day_begin_s) /
         std::max(1.0, layout.day_end_s - layout.day_begin_s);
}

/// Collects entries of the dictionary: names only (without signals), or names and rows.
class DictionaryCollector {
 public:
  DictionaryCollector(const RunSignals* signals, const Robot* robot) : signals_(signals), robot_(robot) {}

  /// A resisting torque on both wheels; with `apart` also left minus right.
  template <class Function>
  void friction(const std::string& family, bool apart, Function&& size) {
    for (int sign : {1, -1}) {
      if (sign < 0 && !apart) break;
      entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
        for (Side side : kSides) {
          const double direction = signals_->direction(side, j);
          const double torque_Nm = direction * size(j, side) * (side == Side::right ? sign : 1);
          entry_rows(j, column(kCurrentLeft, side)) =
              torque_Nm / robot_->motor[side].torque_per_ampere_Nm_A();
        }
      });
    }
  }
  /// A torque on each wheel separately, independent of its direction of rotation.
  template <class Function>
  void torque(const std::string& family, Side side, Function&& size_Nm) {
    entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      entry_rows(j, column(kCurrentLeft, side)) = size_Nm(j) / robot_->motor[side].torque_per_ampere_Nm_A();
    });
  }
  /// A force along the heading.
  template <class Function>
  void force(const std::string& family, Function&& size_N) {
    entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      for (Side side : kSides)
        entry_rows(j, column(kCurrentLeft, side)) = 0.5 * robot_->geometry.wheel_radius_m[side] * size_N(j) /
                                                    robot_->motor[side].torque_per_ampere_Nm_A();
    });
  }
  /// A yaw moment.
  template <class Function>
  void moment(const std::string& family, Function&& size_Nm) {
    entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      for (Side side : kSides)
        entry_rows(j, column(kCurrentLeft, side)) = side_sign(side) * robot_->geometry.wheel_radius_m[side] /
                                                    (2 * robot_->geometry.half_track_m) * size_Nm(j) /
                                                    robot_->motor[side].torque_per_ampere_Nm_A();
    });
  }
  /// What the motors' currents read beyond the true ones; nothing where no sensor reads them. The motor power
  /// that it adds to the log takes part in the battery's balance as the supply counts it.
  template <class Function>
  void reading(const std::string& family, const Prediction* prediction, Function&& size_A) {
    entry(family, "current reading", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      for (Side side : kSides) {
        if (signals_->motor_current_A[side].size() == 0) continue;
        const double current_A = size_A(j, side);
        entry_rows(j, column(kCurrentLeft, side)) = current_A;
        entry_rows(j, column(kWindingLeft, side)) = -prediction->reading_resistance_ohm[side][j] * current_A;
        entry_rows(j, kDriverPower) -=
            counted_share(side, *prediction, j) * prediction->voltage_V[side][j] * current_A;
      }
    });
  }
  /// How much of a motor's power the supply counts: the slope of its mean over the kernel.
  [[nodiscard]] double counted_share(Side side, const Prediction& prediction, Eigen::Index j) const {
    constexpr double kStep_W = 1e-4;
    const Sided<double> change_W{prediction.power_change_W.left[j], prediction.power_change_W.right[j]};
    const auto counted_W = [&](double step_W) {
      Sided<double> power_W{prediction.power_W.left[j], prediction.power_W.right[j]};
      power_W[side] += step_W;
      return mean_supply_power_W(robot_->power, power_W, change_W);
    };
    return (counted_W(kStep_W) - counted_W(-kStep_W)) / (2 * kStep_W);
  }

  /// The last entry has the rows of the catalog's effect with this EffectInfo::curve.
  void known_as(const std::string& curve) { entries.back().curve = curve; }
  /// A voltage in the winding's equation.
  template <class Function>
  void voltage(const std::string& family, bool apart, Function&& size_V) {
    for (int sign : {1, -1}) {
      if (sign < 0 && !apart) break;
      entry(family, "voltage", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
        for (Side side : kSides)
          entry_rows(j, column(kWindingLeft, side)) = size_V(j, side) * (side == Side::right ? sign : 1);
      });
    }
  }
  /// Supply power in addition to the motors' power.
  template <class Function>
  void battery_power(const std::string& family, Function&& size_W) {
    entry(family, "battery power",
          [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) { entry_rows(j, kDriverPower) = size_W(j); });
  }
  /// A voltage in the battery's equation.
  template <class Function>
  void battery_voltage(const std::string& family, Function&& size_V) {
    entry(family, "battery voltage",
          [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) { entry_rows(j, kSupplyVoltage) = size_V(j); });
  }
  /// Speed along the heading and yaw rate that differ from those of the wheels.
  template <class Along, class Yaw>
  void motion(const std::string& family, Along&& along_m_s, Yaw&& yaw_rad_s) {
    double x_m = 0, y_m = 0, heading_rad = 0;
    entry(family, "motion", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      const double along = along_m_s(j), yaw = yaw_rad_s(j), period_s = signals_->period_s;
      x_m += along * std::cos(signals_->heading_rad[j]) * period_s;
      y_m += along * std::sin(signals_->heading_rad[j]) * period_s;
      heading_rad += yaw * period_s;
      entry_rows(j, kGyro) = yaw;
      entry_rows(j, kHeading) = heading_rad;
      entry_rows(j, kPositionX) = x_m;
      entry_rows(j, kPositionY) = y_m;
    });
  }

  std::vector<DictionaryEntry> entries{};
  std::vector<Eigen::MatrixXd> rows{};

 private:
  static Eigen::Index column(Channel left, Side side) { return left + (side == Side::left ? 0 : 1); }

  template <class Function>
  void entry(const std::string& family, const std::string& channel, Function&& fill) {
    entries.push_back({.family = family, .channel = channel});
    if (!signals_) return;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(signals_->size(), kChannelCount);
    for (Eigen::Index j = 0; j < signals_->size(); ++j) fill(j, matrix);
    remove_pose_means(matrix);
    rows.push_back(std::move(matrix));
  }

  const RunSignals* signals_;
  const Robot* robot_;
};

/// Variables of the wheels' torques, of a force or of a moment; entries of the current rows. `s` and `robot`
/// are null where only names are collected.
void add_mechanics(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                   const Robot* robot);
/// The motor's own torque and what its current reads.
void add_motors(DictionaryCollector& out, const Robot* robot, const Prediction* p);
/// Variables of a winding's voltage.
void add_windings(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                  const Prediction* p);
/// Variables of the supply's power and voltage.
void add_supply(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                const Prediction* p);
/// Variables of the motion relative to the wheels.
void add_motion(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                const Robot* robot);

}  // namespace joulepath
