#include "diagnosis/checks/faults.hpp"

#include <cmath>
#include <numbers>

#include "diagnosis/thresholds.hpp"
#include "model/assert.hpp"
#include "model/kinematics.hpp"
#include "model/log_columns.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180;
constexpr double kRadSPerRpm = std::numbers::pi / 30;
/// Factors that are not unit conversions, outside the range that an effect may cause (kMostEffectFactor).
constexpr double kFactors[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 2.0, 2.5, 3.3, 5.0, 10.0, 20.0, 50.0};

const LogColumn& log_column(const std::string& name) {
  const LogColumn* known = find_log_column(name);
  JOULEPATH_ASSERT(known, "a fault of a column that no log has");
  return *known;
}

using Names = std::vector<std::string>;

/// Columns of one quantity; two where it has a left and a right side.
struct Quantity {
  Names columns{};
  std::vector<double> units{};
  bool may_be_inverted{true};
};

class Faults {
 public:
  explicit Faults(const Run& run) : log_(run.log), derived_(run.wheels_from_body_speeds) {}

  std::vector<Fault> list() {
    const Names speed{"wheel_speed_left_rad_s", "wheel_speed_right_rad_s"};
    const Names voltage{"motor_voltage_left_V", "motor_voltage_right_V"};
    const Names current{"motor_current_left_A", "motor_current_right_A"};
    std::vector<Quantity> quantities{{current, {1e-3}},
                                     {voltage, {1e-3}},
                                     {{"gyro_yaw_rate_rad_s"}, {kRadPerDegree}},
                                     {{"heading_rad"}, {kRadPerDegree}},
                                     {{"battery_current_A"}, {1e-3}},
                                     {{"battery_voltage_V"}, {1e-3}, false},
                                     {{"position_x_m", "position_y_m"}, {1e-3, 1e-2}}};
    if (derived_) {
      quantities.push_back({{"linear_speed_m_s"}, {1e-3, 1 / 3.6}});
      quantities.push_back({{"angular_speed_rad_s"}, {kRadPerDegree, kRadSPerRpm}});
    } else {
      quantities.push_back({speed, {kRadSPerRpm, kRadPerDegree, 2 * std::numbers::pi}});
      swap({speed});
      swap({speed, voltage, current});
    }
    swap({current});
    swap({voltage});
    swap({voltage, current});
    for (const Quantity& quantity : quantities) invert(quantity);
    for (const Quantity& quantity : quantities)
      for (double unit : quantity.units) scale("unit", quantity, unit);
    for (double unit : {1e-3, 1e-6, 1e-9})
      if (mean_step_s() * unit >= kShortestPeriod_s)
        add({"clock", "time_s", {{.column = "time_s", .scale = unit}}});
    for (const Quantity& quantity : quantities)
      for (double factor : kFactors) scale("scaled", quantity, factor);
    return std::move(faults_);
  }

 private:
  bool logged(const Names& columns) const {
    for (const std::string& column : columns)
      if (log_column(column).of(log_).empty()) return false;
    return true;
  }

  double mean_step_s() const {
    return log_.size() < 2
               ? 0.0
               : (log_.time_s.back() - log_.time_s.front()) / static_cast<double>(log_.size() - 1);
  }

  void add(Fault fault) { faults_.push_back(std::move(fault)); }

  void swap(const std::vector<Names>& pairs) {
    Fault fault{.kind = "swapped"};
    for (const Names& pair : pairs) {
      if (!logged(pair)) continue;
      append_item(fault.channel, pair[0] + ", " + pair[1]);
      fault.columns.push_back({.column = pair[0], .from = pair[1]});
      fault.columns.push_back({.column = pair[1], .from = pair[0]});
    }
    if (!fault.columns.empty()) add(std::move(fault));
  }

  void invert(const Quantity& quantity) {
    if (quantity.may_be_inverted) scale("inverted", quantity, -1.0);
  }

  /// Scales each column separately, and both together.
  void scale(const char* kind, const Quantity& quantity, double factor) {
    Fault both{.kind = kind};
    for (const std::string& column : quantity.columns) {
      if (!logged({column})) continue;
      const ColumnRepair repair{.column = column, .scale = factor};
      add({kind, column, {repair}});
      append_item(both.channel, column);
      both.columns.push_back(repair);
    }
    if (both.columns.size() > 1) add(std::move(both));
  }

  const Trajectory& log_;
  bool derived_{};
  std::vector<Fault> faults_{};
};

void derive_wheels(Trajectory& log, const Geometry& geometry) {
  for (std::size_t i = 0; i < log.size(); ++i) {
    const Sided<double> wheels =
        wheel_speeds_rad_s(geometry, log.linear_speed_m_s[i], log.angular_speed_rad_s[i]);
    log.wheel_speed_rad_s.left[i] = wheels.left, log.wheel_speed_rad_s.right[i] = wheels.right;
  }
}

}  // namespace

std::vector<Fault> possible_faults(const Run& run) { return Faults(run).list(); }

Fault with_factor(Fault fault, double factor) {
  for (ColumnRepair& repair : fault.columns) repair.scale = factor;
  return fault;
}

Run repaired(Run run, const std::vector<ColumnRepair>& columns, const Geometry& geometry) {
  std::vector<std::vector<double>> channels;
  bool body_speed = false;
  for (const ColumnRepair& repair : columns) {
    channels.push_back(log_column(repair.from.empty() ? repair.column : repair.from).of(run.log));
    for (double& value : channels.back()) value *= repair.scale;
    if (repair.absent) channels.back().clear();
    body_speed |= repair.column == "linear_speed_m_s" || repair.column == "angular_speed_rad_s";
  }
  for (std::size_t k = 0; k < columns.size(); ++k)
    log_column(columns[k].column).channel(run.log) = std::move(channels[k]);
  if (body_speed && run.wheels_from_body_speeds) derive_wheels(run.log, geometry);
  return run;
}

}  // namespace joulepath
