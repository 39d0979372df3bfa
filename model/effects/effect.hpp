#pragma once

#include <string_view>

#include "model/motion.hpp"

namespace joulepath {

/// Where in the chain from body to battery an effect acts. Each stage has one hook, a member function
/// that the effect's struct offers; whoever evaluates the chain calls the hooks that it finds.
///
/// | stage      | hook                                                                     |
/// |------------|--------------------------------------------------------------------------|
/// | parameters | void adjust(Robot&): other constants; double payload_kg(double stated)   |
/// | body       | BodyLoad<Real> body_load(BodyContext<Real>): resisting force and moment  |
/// | wheel      | Real shaft_torque_Nm(WheelContext<Real>): torque that resists, signed    |
/// | gear       | double torque_loss_fraction(): of the transmitted torque                 |
/// | contact    | double creep_m_s_N(): speed lost per force at the contact                |
/// | winding    | double resistance_factor(double time_of_day_s)                           |
/// | driver     | double voltage_drop_V(): between command and motor                       |
/// | supply     | void adjust(Robot&)                                                      |
/// | instrument | void distort(Trajectory&): what the log shows; planning ignores it       |
///
/// A law with regions also offers bool branch(const Site&): which side of its border a site is on. The
/// energy integral splits its intervals there.
enum class Stage { parameters, body, wheel, gear, contact, winding, driver, supply, instrument };

constexpr std::string_view stage_name(Stage stage) {
  constexpr std::string_view names[] = {"parameters", "body",   "wheel",  "gear",      "contact",
                                        "winding",    "driver", "supply", "instrument"};
  return names[static_cast<int>(stage)];
}

/// What the catalog, the documents and the diagnosis know about an effect.
struct EffectInfo {
  std::string_view name{};
  std::string_view kind{};  ///< resistance | mass and geometry | floor | electrical | instruments
  Stage stage{};
  std::string_view law{};
  std::string_view validity{};
  std::string_view source{};
  std::string_view gazebo{};  ///< counterpart in Gazebo (SDFormat), "none" where there is none
  std::string_view mujoco{};  ///< counterpart in MuJoCo (MJCF)
};

/// One parameter of an effect. `min`, `max`: what is accepted; `typical`: a size worth noticing, the
/// step that differencing starts from.
template <class Effect>
struct EffectParameter {
  std::string_view name{};
  std::string_view unit{};
  double min{};
  double max{};
  double typical{};
  std::string_view meaning{};
  double Effect::*member{};
};

/// Force against the heading and moment against counter-clockwise yaw, to be overcome by the wheels.
template <class Real>
struct BodyLoad {
  Real force_N{};
  Real moment_Nm{};
};

template <class Real>
struct BodyContext {
  const Robot& robot;
  const Site& site;
  double mass_kg{};
  double first_moment_kg_m{};
  Real speed_m_s{};
  Real yaw_rate_rad_s{};
  double memory{};  ///< of the effect that is asked
};

template <class Real>
struct WheelContext {
  const Site& site;
  Side side{};
  Real speed_rad_s{};
  double direction{};  ///< sign of the wheel's speed
  double radius_m{};
  double normal_load_N{};  ///< N = m g / 2
};

}  // namespace joulepath
