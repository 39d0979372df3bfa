#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/operating_point.hpp"
#include "model/plant.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/affine_fit.hpp"
#include "planner/path/shape/spline_slopes.hpp"
#include "planner/profile/draft_series.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The least cost of driving a spline, by the variables in the order of all_of().
class SplineCost {
 public:
  SplineCost(const Plant& plant, double price_W, std::size_t nodes = 1600)
      : plant_(plant), price_W_(price_W), nodes_(nodes) {}

  double operator()(const FreeSpline& spline) {
    const std::optional<Path> path = free_spline_path(spline);
    if (!path) return NAN;
    ProfileRequest request{.piece = path->pieces.front(),
                           .plant = plant_,
                           .limits = *plant_.robot.limits,
                           .payload = {4.0, 4.0},
                           .nodes = nodes_,
                           .draft = true};
    if (price_W_ > 0) request.time = {.mode = TimeMode::time_price, .price_W = price_W_};
    const std::optional<DraftSeries::Cost> cost = series_.solve(request);
    return cost ? cost->cost_J : NAN;
  }
  SplineSlopes slopes(const FreeSpline& spline) const {
    return spline_slopes(spline, std::get<Curve>(free_spline_path(spline)->pieces.front()), series_.slopes());
  }

 private:
  Plant plant_;
  double price_W_;
  std::size_t nodes_;
  DraftSeries series_{1e-10};
};

std::vector<double*> all_of(FreeSpline& spline) {
  std::vector<double*> all{&spline.start_heading_rad, &spline.start_handle_m, &spline.goal_heading_rad,
                           &spline.goal_handle_m};
  for (std::size_t i = 1; i + 1 < spline.points_m.size(); ++i)
    for (double& coordinate_m : spline.points_m[i]) all.push_back(&coordinate_m);
  return all;
}

std::vector<double> all_of(const SplineSlopes& slopes) {
  std::vector<double> all{slopes.by_start_heading_rad, slopes.by_start_handle_m, slopes.by_goal_heading_rad,
                          slopes.by_goal_handle_m};
  for (std::size_t i = 1; i + 1 < slopes.by_point_m.size(); ++i)
    all.insert(all.end(), slopes.by_point_m[i].begin(), slopes.by_point_m[i].end());
  return all;
}

/// Largest difference between the gradient and central differences of the optimal cost, of the gradient.
double error_of(SplineCost& cost, const FreeSpline& spline) {
  const double step = 1e-4;
  (void)cost(spline);
  const std::vector<double> gradient = all_of(cost.slopes(spline));
  double size = 0, error = 0;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    FreeSpline low = spline, high = spline;
    *all_of(low)[i] -= step;
    *all_of(high)[i] += step;
    const double difference = (cost(high) - cost(low)) / (2 * step);
    size = std::max(size, std::abs(gradient[i]));
    error = std::max(error, std::abs(gradient[i] - difference));
  }
  return error / size;
}

const FreeSpline kWide{.points_m = {{0, 0}, {2.5, 0.4}, {5, 2}},
                       .start_heading_rad = 0.6,
                       .start_handle_m = 0.9,
                       .goal_heading_rad = 0.8,
                       .goal_handle_m = 1.1};
/// Leaves on a short handle and swings round: the inner wheel reverses.
const FreeSpline kSwinging{.points_m = {{0, 0}, {0.5, 0.35}, {3, 0.2}},
                           .start_heading_rad = 2.0,
                           .start_handle_m = 0.15,
                           .goal_heading_rad = -0.2,
                           .goal_handle_m = 0.8};

/// Swings round to a goal behind it, with a joint in the bend.
const FreeSpline kRound{.points_m = {{0, 0}, {-0.187, 0.238}, {0.035, 0.508}, {5, 0}},
                        .start_heading_rad = 3.12,
                        .start_handle_m = 0.143,
                        .goal_heading_rad = -0.1,
                        .goal_handle_m = 1.5};

// The derivative of a least cost is that of the Lagrangian at the solution (envelope theorem).
TEST(CurveSlopes, AreTheDerivativesOfTheLeastCost) {
  for (const double price_W : {0.0, 40.0}) {
    SplineCost cost(make_nominal_plant(testing::nomad()), price_W);
    EXPECT_LT(error_of(cost, kWide), 1e-5) << price_W;
  }
}

// Nodes keep their shares of the length, so they move along the curve when its shape changes.
TEST(CurveSlopes, AreThoseOfACoarseGridToo) {
  SplineCost cost(make_nominal_plant(testing::nomad()), 0.0, 60);
  EXPECT_LT(error_of(cost, kWide), 1e-4);
}

// The limit of yaw acceleration reads the slope of the curvature, which jumps at a joint: a place at the end
// of a span belongs to that span.
TEST(CurveSlopes, KeepTheSidesOfAJointApart) {
  SplineCost cost(make_nominal_plant(testing::nomad()), 0.0, 200);
  EXPECT_LT(error_of(cost, kRound), 0.01);
}

TEST(CurveSlopes, CountThePlaceWhereAWheelReverses) {
  SplineCost cost(make_nominal_plant(testing::nomad()), 0.0);
  EXPECT_LT(error_of(cost, kSwinging), 1e-4);
}

/// The caps of a coarse grid fall steeply within a segment where nothing bounds the speed on the straight.
TEST(CurveSlopes, FollowCapsThatFallSteeply) {
  Robot robot = testing::nomad();
  robot.limits->speed_m_s = kNoLimit;
  SplineCost cost(make_nominal_plant(robot), 40.0, 8);
  EXPECT_LT(error_of(cost, kWide), 0.1);
}

/// A hasty drive keeps the lateral acceleration or the yaw rate at its limit over much of the curve.
TEST(CurveSlopes, CountWhatTheCurveAllowsOfSpeed) {
  for (double Limits::*limit : {&Limits::lateral_acceleration_m_s2, &Limits::yaw_rate_rad_s}) {
    Robot robot = testing::nomad();
    (*robot.limits).*limit = 0.1;
    SplineCost cost(make_nominal_plant(robot), 40.0);
    EXPECT_LT(error_of(cost, kWide), 1e-2) << (limit == &Limits::yaw_rate_rad_s);
  }
}

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
