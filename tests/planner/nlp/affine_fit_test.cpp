#include "planner/nlp/transcription/affine_fit.hpp"

#include <gtest/gtest.h>

#include "model/operating_point.hpp"
#include "model/plant.hpp"
#include "planner/motion/path_motion.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Currents and voltages are linear in acceleration, rate and its square under laws that are linear in speed
/// and force alone.
TEST(AffineFit, HoldsForLinearLawsOnly) {
  const auto is_affine = [](const EffectSetting& effect) {
    const Plant plant = make_plant(testing::nomad(), {effect});
    const PathPiece lane = straight_piece({}, 2.0);
    const PathMotion motion(lane, plant, {});
    Sided<nlp::AffineWheel> wheel;
    return nlp::AffineFit(plant).at(motion.rates(1.0), motion.site(1.0, 0.0), wheel);
  };
  EXPECT_TRUE(is_affine({.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}}));
  EXPECT_TRUE(is_affine({.name = "viscous_friction", .parameters = {{"coefficient_Nm_s_rad", 0.01}}}));
  EXPECT_TRUE(is_affine({.name = "quadratic_drag", .parameters = {{"coefficient_N_s2_m2", 20.0}}}));
  EXPECT_FALSE(
      is_affine({.name = "stribeck_friction", .parameters = {{"torque_Nm", 0.3}, {"speed_rad_s", 2.0}}}));
}

/// One fit serves places whose wheels turn in other directions and which carry another load.
TEST(AffineFit, IsTheModelAtEveryPlace) {
  Robot robot = testing::nomad();
  robot.geometry.center_of_mass_offset_m = -0.1;  // adds omega^2 and v omega
  const Plant plant = make_nominal_plant(robot);
  nlp::AffineFit fit(plant);
  for (const double load_kg : {0.0, 8.0})
    for (const double turn : {-9.0, 0.3, 9.0})
      for (const double along : {-1.0, 0.0, 1.0}) {
        const PathRates rates{along, turn, 0.7};
        const Sided<double> speed = wheel_speeds_rad_s(plant.robot.geometry, along, turn);
        const Site site{.payload_kg = load_kg,
                        .wheel_direction = {sign_of(speed.left), sign_of(speed.right)}};
        Sided<nlp::AffineWheel> wheel;
        ASSERT_TRUE(fit.at(rates, site, wheel));
        for (const auto& [u, a] : {std::pair{0.6, -0.4}, {0.0, 0.5}}) {
          const auto exact = operating_point(plant, PathMotion::body_motion<double>(rates, u, a), site);
          for (const Side side : kSides) {
            EXPECT_NEAR(wheel[side].current_A(a, u * u, u), exact[side].current_A, 1e-11);
            EXPECT_NEAR(wheel[side].voltage_V(a, u * u, u), exact[side].voltage_V, 1e-11);
            EXPECT_NEAR(wheel[side].force_N(a, u * u, u), exact[side].contact_force_N, 1e-9);
          }
        }
      }
}

}  // namespace
}  // namespace joulepath
