#pragma once

#include <array>

#include "model/operating_point.hpp"
#include "model/power.hpp"

namespace joulepath {

/// The integrated state: pose, speeds, currents, memories of the effects, then the integrals that give
/// energies and mean readings.
enum DriveIndex : std::size_t {
  kX,
  kY,
  kYaw,
  kAngleLeft,
  kAngleRight,
  kVelocities,  ///< four: v, omega, left wheel, right wheel; see Surface
  kArmatureLeft = kVelocities + 4,
  kArmatureRight,
  kMemory,                                ///< kMaxMemories of them
  kVoltSeconds = kMemory + kMaxMemories,  ///< left, right
  kCharge = kVoltSeconds + 2,
  kEnergy = kCharge + 2,
  kBatteryVoltSeconds = kEnergy + 2,
  kBatteryCharge,
  kBatteryEnergy,  ///< at the terminals, standby included
  kBatteryLoss,
  kCopperLoss,
  kDriverLoss,
  kGearLoss,
  kWheelFriction,
  kBodyWork,  ///< done against the effects' forces on the body
  kCreepLoss,
  kDriveSize
};
using DriveState = std::array<double, kDriveSize>;
inline constexpr std::size_t kVelocity = kVelocities;  ///< kVelocity + Surface: a speed

/// The four speeds, each a place where dry friction can act: travelling and turning of the body (where
/// an effect resists them) and each wheel's own turning.
enum Surface : std::size_t { kTravel, kTurn, kLeftWheel, kRightWheel, kSurfaces };
constexpr Surface kAllSurfaces[] = {kTravel, kTurn, kLeftWheel, kRightWheel};
constexpr Surface surface_of(Side side) { return side == Side::left ? kLeftWheel : kRightWheel; }
using Velocity = std::array<double, kSurfaces>;

/// -1, +1: slides that way; 0: holds.
using FrictionMode = std::array<int, kSurfaces>;

/// What is held constant over a control period.
struct DriveInput {
  Sided<double> voltage_V{};  ///< commanded
  bool coasting{};            ///< the bridges are open: no current
  double payload_kg{};        ///< as stated
  double push_N{};            ///< along the heading, from outside
};

/// The robot as an ordinary differential equation with dry friction: [P1, Eq. (25)], plus creep at the
/// contacts, inductance, current limit and battery.
///
/// Within one FrictionMode the right-hand side is smooth. Holding surfaces carry the reaction that keeps
/// them at rest, up to what friction can give: a complementarity problem with bounds, at most four
/// unknowns, solved by projected Gauss-Seidel. The modes change at events: see DriveIntegrator.
class Drive {
 public:
  explicit Drive(Plant plant, double time_of_day_s = 0.0);

  void set_input(const DriveInput& input);
  const DriveInput& input() const { return input_; }
  const Plant& plant() const { return plant_; }

  struct Instant {
    DriveState derivative{};
    Sided<double> current_A{};
    Sided<double> voltage_V{};  ///< at the drivers' outputs
    Sided<double> contact_force_N{};
    double battery_voltage_V{};
    bool battery_gives_way{};  ///< the demand exceeds the battery's power
    FrictionMode release{};    ///< the direction in which a holding surface breaks away; 0: it holds
  };
  [[nodiscard]] Instant evaluate(const DriveState& state, double time_s, const FrictionMode& mode) const;

  /// Sets the remaining speed of a surface that has come to rest to zero, as an impulse on it would.
  void stop(DriveState& state, Surface surface) const;

  bool is_active(Surface surface) const { return active_[surface]; }

  /// True: body and wheels move apart, as states of their own. Contacts stiffer than kStiffest_N_s_m
  /// creep by force/stiffness at once: their time constant is below a millisecond.
  bool creeps() const { return creeps_; }

  /// Kinetic energy of body and wheels, and magnetic energy of the windings (J).
  double stored_energy_J(const DriveState& state) const;

  static constexpr double kStiffest_N_s_m = 5000.0;

 private:
  struct Forces;
  Site site_at(const DriveState& state, double time_s, const FrictionMode& mode) const;
  void motors(const DriveState& state, double hot, Instant& instant, Forces& forces) const;
  void body_forces(const DriveState& state, const Site& site, Forces& forces) const;
  void wheel_forces(const DriveState& state, const Site& site, Forces& forces) const;
  void bounds(const DriveState& state, Site site, const FrictionMode& mode, Forces& forces) const;
  Velocity respond(const Velocity& force) const;
  void hold(const FrictionMode& mode, Forces& forces, Velocity& acceleration, Instant& instant) const;
  void contact_forces(const Forces& forces, const Velocity& acceleration, Instant& instant) const;
  void motion(const DriveState& state, const Site& site, const Velocity& acceleration,
              Instant& instant) const;
  void integrals(const DriveState& state, const Forces& forces, double hot, Instant& instant) const;
  void refresh_response();

  Plant plant_;
  DriveInput input_{};
  MassProperties mass_{};
  double time_of_day_s_{};
  bool creeps_{};
  std::array<bool, kSurfaces> active_{};
  std::array<Velocity, kSurfaces> response_{};  ///< acceleration per generalized force, symmetric
};

}  // namespace joulepath
