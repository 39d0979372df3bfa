#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "planner/motion/limit_check.hpp"
#include "planner/motion/replay.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/certification.hpp"
#include "planner/profile/first_guess.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"
#include "tests/support/with_room.hpp"

namespace joulepath {
namespace {

TEST(Bound, OfAStraightLineIsBelowTheClosedFormAndComesClose) {
  Robot robot = testing::nomad();
  robot.inertia.wheel_axle_inertia_kg_m2 = 0.148 - 23.98 * 0.01 / 2;
  robot.power = {.standby_W = 0, .regeneration_efficiency = 1};
  for (Motor* motor : {&robot.motor.left, &robot.motor.right})
    motor->max_voltage_V = motor->max_current_A = kNoLimit;
  for (SolverChoice solver : {SolverChoice::fast, SolverChoice::ipopt}) {
    const ProfileRequest request{.piece = straight_piece({}, 10),
                                 .plant = make_plant(robot),
                                 .limits = {.speed_m_s = 5},
                                 .time = {TimeMode::fixed_time, 17.3694},
                                 .solver = solver};
    const ProfileResult result = solve_profile(request);
    EXPECT_LE(result.summary.lower_bound_J, 79.5060763);
    EXPECT_GE(result.summary.lower_bound_J, 79.5060763 * (1 - 1e-5));
    EXPECT_EQ(result.summary.status, SolveStatus::optimal);
  }
}

TEST(Bound, IsBelowEveryFineProfileThatKeepsTheLimits) {
  testing::RandomProfiles random(6);
  for (int i = 0; i < 12; ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    if (i % 3 == 0) request.plant.robot.power.standby_W = 0;
    request.solver = SolverChoice::fast;
    request.nodes = i % 2 == 0 ? 60 : 200;
    request.time = {.mode = i % 2 == 0 ? TimeMode::free_time : TimeMode::time_budget, .duration_s = 60};
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile) << result.summary.message;
    const double energy_J = replay(request, *result.profile).energy_J;
    EXPECT_LE(result.summary.lower_bound_J, energy_J * (1 + 1e-12)) << i;
    EXPECT_LE(result.summary.gap_percent, 0.1) << i;
    ProfileRequest fine = testing::with_room(request, 1e-6);
    fine.nodes = 1600;
    const ProfileResult other = solve_profile(fine);
    ASSERT_TRUE(other.profile) << other.summary.message;
    const ReplayResult strict = replay(request, *other.profile);
    ASSERT_LE(strict.worst_violation, 1e-9) << i << strict.limit;
    EXPECT_LE(result.summary.lower_bound_J, strict.energy_J) << i << " " << result.summary.gap_percent;
  }
}

/// Of a gap of 10 J a tenth or more belongs to profiles that are not near the one found.
/// Copper loss at a price of p joules beside itself is the copper loss of 1 + p times the resistance, where
/// no voltage binds: the same profile, bound and grid.
TEST(Bound, APriceOfHeatIsThatOfMoreResistance) {
  constexpr double kPrice = 20;
  for (const double jerk_m_s3 : {kNoLimit, 0.8}) {
    ProfileRequest priced{.piece = straight_piece({}, 6),
                          .plant = make_plant(testing::nomad()),
                          .limits = {.speed_m_s = 0.8, .acceleration_m_s2 = 0.5, .deceleration_m_s2 = 0.5},
                          .solver = SolverChoice::fast};
    priced.limits.jerk_m_s3 = jerk_m_s3;
    for (const Side side : kSides) priced.plant.robot.motor[side].max_voltage_V = kNoLimit;
    ProfileRequest resistive = priced;
    for (const Side side : kSides) {
      const double resistance_ohm = priced.plant.robot.motor[side].resistance_ohm;
      priced.plant.heat_price_ohm[side] = kPrice * resistance_ohm;
      resistive.plant.robot.motor[side].resistance_ohm = (1 + kPrice) * resistance_ohm;
    }
    const ProfileResult a = solve_profile(priced), b = solve_profile(resistive);
    ASSERT_TRUE(a.profile && b.profile) << a.summary.message << b.summary.message;
    EXPECT_NEAR(a.profile->duration_s(), b.profile->duration_s(), 1e-6 * b.profile->duration_s());
    EXPECT_NEAR(a.summary.lower_bound_J, b.summary.lower_bound_J, 1e-6 * b.summary.lower_bound_J);
    EXPECT_NEAR(a.summary.gap_percent, b.summary.gap_percent, 1e-4);
    EXPECT_EQ(a.summary.nodes, b.summary.nodes);
  }
}

TEST(Bound, IsLocalWhereALargeShareOfTheGapLiesElsewhere) {
  for (const double elsewhere_J : {0.0, 0.5, 2.0, 20.0}) {
    const DualGap gap{.of_segment = {6, 3}, .at_nodes = 1, .elsewhere = elsewhere_J};
    EXPECT_EQ(gap.is_elsewhere(), elsewhere_J > 1) << elsewhere_J;
  }
}

/// A discrete optimum on a grid with its multipliers.
struct Optimum {
  ProfileRequest request;
  PathMotion motion{path_motion(request)};
  nlp::Problem problem{};
  nlp::Solution solution{};

  explicit Optimum(const ProfileRequest& asked) : request(asked) {
    problem = nlp::transcribe(request, motion, nlp::make_grid(motion, request, 80), {}, nullptr);
    solution = nlp::solve_fast(problem, blend(nlp::rate_envelope(problem), 0.5));
  }
  Optimum(const Optimum&) = delete;
};

/// Weak duality: for every costate, no profile costs less than the cost of one less its gap.
TEST(Bound, HoldsForCostatesThatBelongToNoOptimum) {
  testing::RandomProfiles random(15);
  for (int i = 0; i < 8; ++i) {
    const Optimum optimum(random.next(testing::kPathClasses[i % 4]));
    ASSERT_TRUE(optimum.solution.converged);
    std::vector<double> b = optimum.solution.b;
    const Profile best = profile_from_squares(optimum.problem.s, b);
    const double best_J = replay(optimum.request, best).energy_J;
    for (std::size_t k = 1; k + 1 < b.size(); ++k) b[k] *= 1 - 0.05 * random.uniform(0, 1);
    const Profile beside = profile_from_squares(optimum.problem.s, b);
    const CostModel model(optimum.request, optimum.motion, optimum.problem.time_weight_W);
    Costate costate = costate_of(optimum.problem, optimum.solution, beside, model);
    for (std::size_t k = 0; k < costate.psi_start.size(); ++k) {
      costate.psi_start[k] *= random.uniform(0.97, 1.03);
      costate.psi_end[k] *= random.uniform(0.97, 1.03);
    }
    for (std::size_t k = 1; k < costate.psi_start.size(); ++k)
      costate.jump[k] = (costate.psi_start[k] - costate.psi_end[k - 1]) / (2 * beside.rate[k]);
    const DualGap gap = dual_gap(model, costate, beside);
    const double beside_J = replay(optimum.request, beside).energy_J;
    EXPECT_LE(beside_J - gap.total(), best_J * (1 + 1e-5)) << i;
    EXPECT_GT(gap.total(), 0) << i;
  }
}

void expect_least(const ProfileRequest& request, testing::RandomProfiles& random) {
  const PathMotion motion = path_motion(request);
  const CostModel model(request, motion, 3.0);
  for (int i = 0; i < 2000; ++i) {
    const double s = motion.length() * random.uniform(0.001, 0.999);
    const double time_s = random.uniform(0, 100), u = random.uniform(0, 1.2), a = random.uniform(-0.6, 0.6);
    bool allowed = true;
    for_each_limit_use(motion, request.limits, request.speed_caps, {time_s, s, u, a}, 0,
                       [&](std::string_view, double ratio) { allowed &= ratio <= 1; });
    if (!allowed) continue;
    const PlaceCost place(model, s, time_s);
    const double q = random.uniform(-40, 40), own = place.at(u, a) - q * a;
    ASSERT_LE(place.least(u, q), own + 1e-9 * std::abs(own)) << u << " " << a << " " << q;
  }
}

/// The minimum over a place's accelerations is below every state that keeps the limits.
TEST(Bound, LeastCostOfAPlaceIsBelowEveryAllowedState) {
  testing::RandomProfiles random(23);
  const std::vector<std::vector<EffectSetting>> effects{
      {},
      {{.name = "gear_efficiency", .parameters = {{"loss_fraction", 0.1}}}},
      {{.name = "driver_voltage_drop", .parameters = {{"voltage_V", 0.8}}}},
      {{.name = "stribeck_friction", .parameters = {{"torque_Nm", 0.3}, {"speed_rad_s", 2.0}}}},
      {{.name = "winding_heating", .parameters = {{"final_fraction", 0.3}, {"time_constant_s", 60}}}},
      {{.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", 1500}}}}};
  for (std::size_t i = 0; i < 2 * effects.size(); ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    request.plant = make_plant(request.plant.robot, effects[i % effects.size()]);
    request.limits.motor_power_W = 40;
    request.limits.battery_power_W = 60;
    request.limits.wheel_acceleration_rad_s2 = 6;
    expect_least(request, random);
  }
}

}  // namespace
}  // namespace joulepath
