// The simulator's agreement with the power model for every effect.
#include <gtest/gtest.h>

#include <cmath>

#include "model/estimate.hpp"
#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/typical_effect.hpp"

namespace joulepath {
namespace {

using testing::nomad;
using testing::typical_effect;

constexpr double kLoad_kg = 8.0;

/// A run with ramps, cruise, arc, spin and reverse.
SimulationResult run_of(const std::vector<EffectSetting>& effects) {
  const std::vector<PrescribedMotion> tour{
      {.profile = MotionProfile::trapezoid, .speed_m_s = 0.7, .distance_m = 5},
      {.profile = MotionProfile::arc, .speed_m_s = 0.5, .radius_m = 0.8, .angle_rad = 3.0},
      {.profile = MotionProfile::spin, .angle_rad = -2.0},
      {.profile = MotionProfile::trapezoid, .speed_m_s = 0.4, .distance_m = 2, .reverse = true}};
  SimulationRequest request{.robot = nomad(), .effects = effects, .payload_kg = kLoad_kg};
  request.reference = timed_motion(request.robot, tour, {.payload_kg = kLoad_kg}).trajectory;
  request.sensors.sample_rate_Hz = 200;
  return simulate(request);
}

TEST(EffectLaw, TheSimulatorSpendsWhatThePowerModelSaysForEveryEffect) {
  const SimulationResult plain = run_of({});
  const double plain_J = plain.motor_energy_J.left + plain.motor_energy_J.right;
  double changed = 0;
  for (const EffectDescription& description : effect_catalog()) {
    const EffectSetting setting = typical_effect(description);
    const SimulationResult run = run_of({setting});
    const Plant plant = make_plant(nomad(), {setting});
    // The true motion of the body; the model must predict the wheels' deviation from it (creep).
    Trajectory body = run.executed;
    body.wheel_speed_rad_s = {};
    const EnergyEstimate estimate = estimate_energy(plant, body, {.reach_s = 0.0});
    const double energy_J = run.motor_energy_J.left + run.motor_energy_J.right;
    EXPECT_NEAR((estimate.motor_J.left + estimate.motor_J.right) / energy_J, 1.0, 2e-3)
        << description.info.name;
    // Where scrub holds the robot on a straight line, its moment is a reaction that the motion does not
    // determine. It shifts load between the wheels, so only their sum can agree.
    if (setting.name != "turning_scrub") {
      for (Side side : kSides)
        EXPECT_NEAR(estimate.motor_J[side] / run.motor_energy_J[side], 1.0, 2e-3)
            << description.info.name << ' ' << side_name(side);
    }
    changed += std::abs(energy_J / plain_J - 1) > 5e-3;
  }
  EXPECT_GE(changed, 13);  // most typical effects are visible in this run's energy at all
}

}  // namespace
}  // namespace joulepath
