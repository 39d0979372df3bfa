#include "scenarios/robot_files/robot_check.hpp"

#include <array>
#include <cmath>

#include "model/nuisance_correlation.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/robot_files/implausible_constants.hpp"

namespace joulepath {
namespace {

// In SI units both constants are equal for an ideal motor. Kt < Kv: losses inside the motor count as lost
// torque; Kt > Kv: only within the tolerances of a data sheet.
constexpr double kLeastRatio = 0.5, kMostRatio = 1.1, kUsualLeast = 0.9, kUsualMost = 1.1;
constexpr double kNear = 1.15;  ///< a ratio this close to a conversion factor identifies the units

struct Conversion {
  double ratio{};  ///< Kt / Kv as written
  const char* says{};
};
constexpr Conversion kConversions[] = {
    {1000.0, "is the torque constant in mNm/A?"},
    {141.6, "is the torque constant in oz in/A?"},
    {10.197, "is the torque constant in kgf cm/A, or the voltage constant in V/rpm?"},
    {9.5493, "is the voltage constant in V/rpm, or the torque constant in kgf cm/A?"},
    {0.0095493, "is the voltage constant in V/krpm?"},
    {0.001, "is the voltage constant in mV s/rad?"},
};

bool is_near(double value, double other) { return value < kNear * other && value > other / kNear; }

/// The possible units of the two constants as written.
std::string units_mixed_up(const Motor& motor) {
  const double kt = motor.torque_constant_Nm_A, kv = motor.voltage_constant_V_s_rad;
  if (is_near(kt * kv, 9.5493)) return "is the voltage constant a speed constant in rpm/V?";
  if (is_near(kt * kv, 1.0) && !is_near(kt, 1.0))
    return "is the voltage constant a speed constant in rad/s per V?";
  for (const Conversion& conversion : kConversions)
    if (is_near(kt / kv, conversion.ratio)) return conversion.says;
  if (is_near(kt / kv, motor.gear_ratio)) return "is the torque constant seen at the wheel?";
  if (is_near(kv / kt, motor.gear_ratio)) return "is the voltage constant seen at the wheel?";
  return "both are seen at the motor's shaft, in N m/A and V s/rad";
}

double ratio_of(const Motor& motor) { return motor.torque_constant_Nm_A / motor.voltage_constant_V_s_rad; }

using Corner = std::array<double, 2>;

/// Twice the signed area of a triangle.
double turn(const Corner& a, const Corner& b, const Corner& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool cross(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

/// The heat of the windings is stated once.
void check_heat(const Node& root, const Robot& robot) {
  if (!robot.motor.left.thermal) return;
  for (const EffectSetting& effect : robot.effects)
    if (effect.name == "winding_heating")
      root["effects"].fail_found("winding_heating beside motor.thermal", "one of both",
                                 "both are the law of the same winding");
}

/// An uncertain voltage is the constant one: a curve has none of its own.
void check_battery(const Node& root, const Robot& robot) {
  const auto uncertainty = root.find("uncertainty");
  if (robot.battery.open_circuit_curve.empty() || !uncertainty) return;
  if (const auto voltage = uncertainty->find("open_circuit_voltage_V"))
    voltage->fail_found("the sigma of a constant voltage beside the curve open_circuit_voltage",
                        "no such key");
}

/// A name in a pair: a constant whose error is stated.
void check_correlated(const Node& name, const Robot& robot) {
  if (may_correlate(robot, name.text())) return;
  std::vector<std::string> accepted;
  for (const auto& [key, sigma] : robot.uncertainty)
    if (may_correlate(robot, key)) accepted.push_back(key);
  const bool alone = name.text() == "payload_kg" || name.text() == "model_energy";
  name.fail(accepted.empty() ? "keys with a sigma above 0 in uncertainty" : text_of_list(accepted),
            alone ? "this error is independent of those of the constants"
                  : "a constant whose sigma uncertainty states, above 0");
}

bool is_same_pair(const Correlation& one, const Correlation& other) {
  return (one.first == other.first && one.second == other.second) ||
         (one.first == other.second && one.second == other.first);
}

/// Ray casting, edges not included.
bool is_inside(const Footprint& footprint, double x_m, double y_m) {
  if (footprint.polygon_m.empty()) return std::hypot(x_m, y_m) <= footprint.radius_m;
  bool inside = false;
  const auto& p = footprint.polygon_m;
  for (std::size_t i = 0, k = p.size() - 1; i < p.size(); k = i++)
    if ((p[i][1] > y_m) != (p[k][1] > y_m) &&
        x_m < (p[k][0] - p[i][0]) * (y_m - p[i][1]) / (p[k][1] - p[i][1]) + p[i][0])
      inside = !inside;
  return inside;
}

}  // namespace

void check_robot(const Node& root, const Robot& robot) {
  for (const Side side : kSides) {
    const Motor& motor = robot.motor[side];
    const double ratio = ratio_of(motor);
    if (ratio <= kMostRatio && ratio >= kLeastRatio) continue;
    const std::string hint = units_mixed_up(motor);
    if (hint.starts_with("is the voltage constant"))
      root["motor"]["voltage_constant_V_s_rad"].fail_found(
          four_digits(motor.voltage_constant_V_s_rad) + ", " + four_digits(1 / ratio) +
              " times the torque constant",
          "0.9 to 2 times the torque constant (" + four_digits(motor.torque_constant_Nm_A) + " N m/A)", hint);
    root["motor"]["torque_constant_Nm_A"].fail_found(
        four_digits(motor.torque_constant_Nm_A) + ", " + four_digits(ratio) + " times the voltage constant",
        "0.5 to 1.1 times the voltage constant (" + four_digits(motor.voltage_constant_V_s_rad) + " V s/rad)",
        hint);
  }
  check_heat(root, robot);
  check_battery(root, robot);
}

void check_correlation(const Node& item, const Robot& robot, const std::vector<Correlation>& pairs) {
  const Correlation& last = pairs.back();
  check_correlated(item["first"], robot);
  check_correlated(item["second"], robot);
  if (last.first == last.second) item["second"].fail("another key than first", "an error is itself");
  if (std::abs(last.correlation) >= 1) item["correlation"].fail("a number between -1 and 1, both excluded");
  for (std::size_t k = 0; k + 1 < pairs.size(); ++k)
    if (is_same_pair(pairs[k], last))
      item.fail_found("the pair " + last.first + " and " + last.second + " again", "each pair once");
}

void check_correlation_matrix(const Node& list, Robot robot, const std::vector<Correlation>& pairs) {
  std::vector<bool> holds{true};  // with so many pairs
  robot.uncertainty_correlations.clear();
  for (const Correlation& pair : pairs) {
    robot.uncertainty_correlations.push_back(pair);
    holds.push_back(cholesky_factor(nuisance_correlation(robot)).has_value());
  }
  if (holds.back()) return;
  std::size_t last = pairs.size();
  while (!holds[last - 1]) --last;
  list.items()[last - 1].fail_found(
      "correlations that no errors have together", "a positive definite matrix",
      "the pairs before " + pairs[last - 1].first + " and " + pairs[last - 1].second + " make one");
}

void check_polygon(const Node& polygon, const std::vector<std::array<double, 2>>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 2; k < n; ++k)
      if (cross(corners[i], corners[(i + 1) % n], corners[k], corners[(k + 1) % n]))
        polygon.items()[k].fail_found("an edge that crosses the edge from corner " + std::to_string(i),
                                      "corners in their order around the robot",
                                      "two corners may be swapped");
}

bool has_footprint(const Robot& robot) {
  return robot.footprint.radius_m > 0.0 || !robot.footprint.polygon_m.empty();
}

std::vector<std::string> robot_notes(const Robot& robot) {
  std::vector<std::string> notes = implausible_constants(robot);
  const double ratio = ratio_of(robot.motor.left);
  if (ratio < kUsualLeast || ratio > kUsualMost)
    notes.push_back("torque constant " + four_digits(ratio) +
                    " times the voltage constant: for most motors both are the same number in SI units");
  const double half_track_m = robot.geometry.half_track_m;
  const double inner_m = half_track_m * (1.0 - 1e-6);  // a wheel on the edge is not outside
  if (has_footprint(robot) &&
      !(is_inside(robot.footprint, 0.0, inner_m) && is_inside(robot.footprint, 0.0, -inner_m)))
    notes.push_back("the wheels touch the floor " + four_digits(half_track_m) +
                    " m beside the middle of the axle, outside of the footprint: half_track_m is HALF the "
                    "distance between them");
  return notes;
}

}  // namespace joulepath
