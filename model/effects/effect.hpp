#pragma once

#include <span>
#include <string_view>

#include "model/motion.hpp"

namespace joulepath {

/// The stage, from body to battery, at which an effect acts. Each stage has one hook, a member function of
/// the effect's struct; the code that evaluates a stage calls the hooks that exist.
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
/// | instrument | CurrentReading current_reading(Side), double channel_delay_s(): what the log |
/// |            | shows; planning ignores it                                               |
///
/// Further hooks say more about an effect at any stage:
///   double memory_rate_per_m(double memory, double course): the effect has a memory of the course;
///   bool branch(const Site&): which side of the border of its region a site is on; the energy integral
///     splits its intervals there;
///   bool contains(double x_m, double y_m): it acts only inside a region of the floor;
///   static double in_robot_file(const Robot&): its strength replaces this value of the robot file.
enum class Stage { parameters, body, wheel, gear, contact, winding, driver, supply, instrument };

constexpr std::string_view stage_name(Stage stage) {
  constexpr std::string_view names[] = {"parameters", "body",   "wheel",  "gear",      "contact",
                                        "winding",    "driver", "supply", "instrument"};
  return names[static_cast<int>(stage)];
}

/// Signs of the strength that physics allows. A passive resistance only dissipates energy.
enum class Sign { either, nonnegative };

/// How far an effect can absorb errors in the laws of other effects.
enum class Pliability {
  firm,        ///< the law alone decides what the effect looks like
  slow_turns,  ///< its signature at small yaw rates depends on the unknown behavior of its law near zero
  anywhere,    ///< it can fit wherever other laws are inexact
};

/// What logs must contain for the effect to be observable.
struct Needs {
  bool samples{};  ///< readings along a run; energies of whole runs do not show the effect
  bool pose{};
  bool yaw_rate{};  ///< by a gyro or a pose with heading
  bool battery{};   ///< readings at the battery's terminals
  bool time_of_day{};
  bool turns{};
  bool reversing{};
};

/// Properties of an effect for the catalog, the documents and the diagnosis.
struct EffectInfo {
  std::string_view name{};
  std::string_view kind{};  ///< resistance | mass and geometry | floor | electrical | instruments
  Stage stage{};
  std::string_view law{};
  std::string_view validity{};
  std::string_view source{};
  std::string_view gazebo{};  ///< counterpart in Gazebo (SDFormat), "none" where there is none
  std::string_view mujoco{};  ///< counterpart in MuJoCo (MJCF)
  Sign sign{Sign::either};
  Pliability pliability{Pliability::firm};
  Needs needs{};
  std::string_view curve{};  ///< the entry of the diagnosis' dictionary with the same rows, if there is one
};

/// What a parameter does in its effect. The first parameter is the strength, and only the first.
enum class ParameterRole {
  strength,
  inverse_strength,  ///< the strength is 1/parameter: an infinite parameter means no effect
  direction,         ///< rad; the strength and this angle are the polar form of a vector
  shape,             ///< of the law; searched on a grid
  edge,              ///< of a region of the floor, in the order x_min, x_max, y_min, y_max
};

/// A measure of a robot that a typical size is proportional to, and its value for the robot that the
/// catalog's typical sizes are meant for (Nomad Super Scout, 24 kg).
struct Yardstick {
  double (*of)(const Robot&){};
  double reference{};
};

/// One parameter of an effect. `min`, `max`: accepted values; `typical`: a noticeable size, the first step of
/// finite differences. `yardstick` scales `typical` and `grid` to another robot.
/// `grid`: values of a shape parameter to search; empty: multiples of its typical size.
template <class Effect>
struct EffectParameter {
  std::string_view name{};
  std::string_view unit{};
  double min{};
  double max{};
  double typical{};
  std::string_view meaning{};
  double Effect::*member{};
  ParameterRole role{ParameterRole::strength};
  Yardstick yardstick{};
  std::span<const double> grid{};
};

/// Force against the heading and moment against counter-clockwise yaw that the wheels must overcome.
template <class Real>
struct BodyLoad {
  Real force_N{};
  Real moment_Nm{};
};

/// What a motor's current sensor shows: gain * current + offset.
struct CurrentReading {
  double gain{1.0};
  double offset_A{};
};

template <class Real>
struct BodyContext {
  const Robot& robot;
  const Site& site;
  double mass_kg{};
  double first_moment_kg_m{};
  Real speed_m_s{};
  Real yaw_rate_rad_s{};
  double memory{};  ///< of this effect
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
