#include "extensions/onboard/monitor/signatures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/mean_power.hpp"
#include "model/operating_point.hpp"

namespace joulepath {
namespace {

bool has_one_signature(const EffectDescription& effect) {
  if (effect.has_region || effect.has_cells) return false;
  const bool resists = effect.info.kind == "resistance" || effect.info.kind == "floor";
  const bool mechanical = effect.info.stage == Stage::parameters || effect.info.stage == Stage::body ||
                          effect.info.stage == Stage::wheel || effect.info.stage == Stage::gear;
  if (!resists || !mechanical) return false;
  return std::all_of(effect.parameters.begin(), effect.parameters.end(), [](const auto& parameter) {
    return parameter.role != ParameterRole::inverse_strength && parameter.role != ParameterRole::edge;
  });
}

Robot with_twice_the_friction(Robot robot) {
  for (const Side side : kSides) robot.motor[side].friction_torque_Nm *= 2;
  return robot;
}

}  // namespace

Signatures::Signatures(const Robot& robot)
    : base_(make_plant(robot)), resisted_(make_plant(with_twice_the_friction(robot))) {
  for (const EffectDescription& effect : effect_catalog()) {
    if (!has_one_signature(effect)) continue;
    EffectSetting setting{.name = std::string(effect.info.name)};
    for (const ParameterDescription& parameter : effect.parameters)
      setting.parameters[parameter.name] = typical_size(parameter, robot);
    const ParameterDescription* direction = effect.find(ParameterRole::direction);
    for (const double angle_rad : {0.0, std::numbers::pi / 2}) {
      if (direction) setting.parameters[direction->name] = angle_rad;
      for (const Side side : kSides) {
        if (effect.has_side) setting.side = side;
        add(robot, setting);
        if (!effect.has_side) break;
      }
      if (!direction) break;
    }
  }
}

void Signatures::add(const Robot& robot, const EffectSetting& setting) {
  Plant plant = make_plant(robot, {setting});
  if (remembers(plant) && !remembers(base_)) return;
  changed_.push_back(std::move(plant));
  names_.push_back(setting.name);
}

Eigen::VectorXd Signatures::predicted(const Plant& plant, const WindowMean& window, double payload_kg) const {
  const BodyMotion<double>& motion = window.motion;
  Site site = site_of(plant.robot.geometry, {0, 0, window.heading_rad}, payload_kg, motion.speed_m_s,
                      motion.yaw_rate_rad_s);
  site.wheel_direction = window.wheel_direction;
  const Sided<WheelState<double>> wheels = operating_point(plant, motion, site);
  if (!std::isnan(window.current_A.left + window.current_A.right))
    return Eigen::Vector2d(wheels.left.current_A, wheels.right.current_A);
  const PowerSupply& supply = plant.robot.power;
  const Sided<WheelChange> change = change_within(plant, motion, {}, site, window.sigma_s());
  const auto mean_W = [&](Side side) { return wheels[side].power_W + change[side].product_W(); };
  return Eigen::VectorXd::Constant(
      1, mean_supply_power_W(supply, {mean_W(Side::left), mean_W(Side::right)},
                             {change.left.power_W, change.right.power_W}) +
             supply.standby_W);
}

std::optional<WindowEquations> Signatures::equations(const WindowMean& window, double payload_kg) const {
  constexpr double kStep_kg = 1.0;
  const bool currents = !std::isnan(window.current_A.left + window.current_A.right);
  if (!currents && std::isnan(window.battery_power_W)) return std::nullopt;
  const Eigen::VectorXd base = predicted(base_, window, payload_kg);
  WindowEquations rows;
  if (currents)
    rows.residual = Eigen::Vector2d(window.current_A.left, window.current_A.right) - base;
  else
    rows.residual = Eigen::VectorXd::Constant(1, window.battery_power_W) - base;
  rows.per_kg = (predicted(base_, window, payload_kg + kStep_kg) - base) / kStep_kg;
  rows.resistance = predicted(resisted_, window, payload_kg) - base;
  rows.other.resize(base.size(), static_cast<Eigen::Index>(changed_.size()));
  for (std::size_t i = 0; i < changed_.size(); ++i)
    rows.other.col(static_cast<Eigen::Index>(i)) = predicted(changed_[i], window, payload_kg) - base;
  const MassProperties mass = mass_properties(base_.robot, payload_kg);
  const BodyMotion<double>& m = window.motion;
  rows.driving = mass.mass_kg * m.speed_m_s * m.acceleration_m_s2 +
                     mass.yaw_inertia_kg_m2 * m.yaw_rate_rad_s * m.yaw_acceleration_rad_s2 >
                 0;
  return rows;
}

}  // namespace joulepath
