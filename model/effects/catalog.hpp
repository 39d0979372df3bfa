#pragma once

#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "model/effects/caster_swivel.hpp"
#include "model/effects/center_of_mass_offset.hpp"
#include "model/effects/coulomb_friction.hpp"
#include "model/effects/current_sensor_gain.hpp"
#include "model/effects/current_sensor_offset.hpp"
#include "model/effects/direction_dependent_friction.hpp"
#include "model/effects/dragging_wheel.hpp"
#include "model/effects/driver_voltage_drop.hpp"
#include "model/effects/floor_patch.hpp"
#include "model/effects/floor_slope.hpp"
#include "model/effects/gear_efficiency.hpp"
#include "model/effects/payload_mass_error.hpp"
#include "model/effects/quadratic_drag.hpp"
#include "model/effects/regeneration_error.hpp"
#include "model/effects/rolling_resistance.hpp"
#include "model/effects/standby_power_error.hpp"
#include "model/effects/stribeck_friction.hpp"
#include "model/effects/supply_sag.hpp"
#include "model/effects/time_misalignment.hpp"
#include "model/effects/torque_constant_error.hpp"
#include "model/effects/track_width_error.hpp"
#include "model/effects/turning_scrub.hpp"
#include "model/effects/viscous_friction.hpp"
#include "model/effects/wheel_radius_error.hpp"
#include "model/effects/wheel_radius_mismatch.hpp"
#include "model/effects/wheel_slip.hpp"
#include "model/effects/winding_heating.hpp"
#include "model/effects/winding_resistance_error.hpp"
#include "model/effects/yaw_inertia_error.hpp"
#ifdef JOULEPATH_MORE_EFFECTS  // CMake: -DJOULEPATH_MORE_EFFECTS=FILE, effects kept outside of this tree
#include JOULEPATH_MORE_EFFECTS
#else
namespace joulepath {
using MoreEffects = std::tuple<>;
}
#endif

namespace joulepath {

/// The catalog: every effect of the simulator, the planner, the diagnosis and the documents. To add one,
/// write its file and list it here (docs/adding_an_effect.md).
using OwnEffects =
    std::variant<RollingResistance, FloorPatch, StribeckFriction, CoulombFriction, DraggingWheel,
                 DirectionDependentFriction, ViscousFriction, GearEfficiency, TurningScrub, CasterSwivel,
                 QuadraticDrag, WheelSlip, PayloadMassError, CenterOfMassOffset, YawInertiaError,
                 WheelRadiusError, WheelRadiusMismatch, TrackWidthError, FloorSlope, WindingResistanceError,
                 WindingHeating, TorqueConstantError, DriverVoltageDrop, StandbyPowerError, RegenerationError,
                 SupplySag, CurrentSensorOffset, CurrentSensorGain, TimeMisalignment>;

template <class... Own, class... More>
std::variant<Own..., More...> joined(std::variant<Own...>, std::tuple<More...>);
using Effect = decltype(joined(std::declval<OwnEffects>(), std::declval<MoreEffects>()));

/// One parameter of one effect: an EffectParameter without `member`.
struct ParameterDescription {
  std::string name{};
  std::string unit{};
  double min{};
  double max{};
  double typical{};
  std::string meaning{};
  ParameterRole role{};
  Yardstick yardstick{};
  std::vector<double> grid{};
};

/// The typical size on a robot: proportional to the parameter's yardstick, if the parameter has one and its
/// value for the robot is positive; else the catalog's.
[[nodiscard]] double typical_size(const ParameterDescription& parameter, const Robot& robot);

/// Values of a shape parameter to search on a robot.
[[nodiscard]] std::vector<double> search_grid(const ParameterDescription& parameter, const Robot& robot);

struct EffectDescription {
  EffectInfo info{};
  bool has_side{};
  bool has_cells{};
  bool has_region{};                        ///< acts inside a region of the floor only
  bool delays_channels{};                   ///< the motors' voltage and current channels are late
  double (*in_robot_file)(const Robot&){};  ///< what the strength replaces; absent: the strength is a change
  std::vector<ParameterDescription> parameters{};

  [[nodiscard]] const ParameterDescription& strength() const { return parameters.front(); }
  /// The first parameter of that role, or nullptr.
  [[nodiscard]] const ParameterDescription* find(ParameterRole role) const;
  [[nodiscard]] const ParameterDescription* find(const std::string& name) const;
};

/// All effects, in the catalog's order.
const std::vector<EffectDescription>& effect_catalog();

/// The catalog's entry of that name, or nullptr.
const EffectDescription* find_effect(const std::string& name);

/// The effect of a robot file's entry. Throws ConfigError (without a mark) for an unknown
/// name or parameter, a missing parameter or side, or a value out of range.
Effect make_effect(const EffectSetting& setting);

/// The robot file's entry of an effect; inverse of make_effect().
EffectSetting setting_of(const Effect& effect);

}  // namespace joulepath
