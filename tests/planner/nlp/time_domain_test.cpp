#include <gtest/gtest.h>

#include <cmath>
#include <nlopt.hpp>

#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The same problem in time, by Hermite-Simpson collocation: accelerations at nodes and middles of equal
/// intervals are unknown, states follow from the (linear) defects,
///   v+ = v + h/6 (a + 4 a_m + a+),   v_m = (v + v+)/2 + h/8 (a - a+),
/// the same for s from v, and the cost is Simpson's sum of the power. Shares nothing with the product's
/// transcription but the power model; NLopt's SLSQP with differenced gradients solves it.
class TimeDomain {
 public:
  TimeDomain(const ProfileRequest& request, double duration_s)
      : motion_(path_motion(request)),
        step_s_(duration_s / kIntervals),
        standby_W_(request.plant.robot.power.standby_W) {}

  static constexpr int kIntervals = 24;
  static constexpr int kUnknowns = 2 * kIntervals + 1;

  struct Outcome {
    double energy_J{}, end_s{}, end_rate{};
  };

  Outcome evaluate(const std::vector<double>& a) const {
    Outcome out;
    double s = 0, v = 0;
    const auto power_W = [&](double place, double rate, double acceleration) {
      return drive_power_W(motion_, {0, place, rate, acceleration}) + standby_W_;
    };
    for (std::size_t k = 0; k < kIntervals; ++k) {
      const double a0 = a[2 * k], am = a[2 * k + 1], a1 = a[2 * k + 2], h = step_s_;
      const double v1 = v + h / 6 * (a0 + 4 * am + a1), vm = (v + v1) / 2 + h / 8 * (a0 - a1);
      const double s1 = s + h / 6 * (v + 4 * vm + v1), sm = (s + s1) / 2 + h / 8 * (v - v1);
      out.energy_J += h / 6 * (power_W(s, v, a0) + 4 * power_W(sm, vm, am) + power_W(s1, v1, a1));
      s = s1;
      v = v1;
    }
    out.end_s = s;
    out.end_rate = v;
    return out;
  }

  double least_energy_J(double length, double duration_s) const {
    nlopt::opt solver(nlopt::LD_SLSQP, kUnknowns);
    std::vector<double> a(kUnknowns);
    for (int i = 0; i < kUnknowns; ++i)  // the parabola of the rate
      a[static_cast<std::size_t>(i)] =
          6 * length / (duration_s * duration_s) * (1 - 2.0 * i / (kUnknowns - 1));
    using Getter = double (*)(const Outcome&, double);
    struct Row {
      const TimeDomain* domain;
      double target;
      Getter get;
    };
    const auto differenced = [](const std::vector<double>& x, std::vector<double>& gradient, void* data) {
      const Row& row = *static_cast<Row*>(data);
      const double value = row.get(row.domain->evaluate(x), row.target);
      std::vector<double> moved = x;
      for (std::size_t i = 0; i < gradient.size(); ++i) {
        constexpr double kStep = 1e-5;
        moved[i] = x[i] + kStep;
        const double up = row.get(row.domain->evaluate(moved), row.target);
        moved[i] = x[i] - kStep;
        gradient[i] = (up - row.get(row.domain->evaluate(moved), row.target)) / (2 * kStep);
        moved[i] = x[i];
      }
      return value;
    };
    Row energy{this, 0, [](const Outcome& o, double) { return o.energy_J; }};
    Row distance{this, length, [](const Outcome& o, double target) { return o.end_s - target; }};
    Row rest{this, 0, [](const Outcome& o, double) { return o.end_rate; }};
    solver.set_min_objective(differenced, &energy);
    solver.add_equality_constraint(differenced, &distance, 1e-9);
    solver.add_equality_constraint(differenced, &rest, 1e-9);
    solver.set_lower_bounds(-0.5);
    solver.set_upper_bounds(0.5);
    solver.set_ftol_rel(1e-10);
    solver.set_maxeval(300);
    double value = 0;
    solver.optimize(a, value);
    return value;
  }

 private:
  PathMotion motion_;
  double step_s_{};
  double standby_W_{};
};

TEST(TimeDomain, HermiteSimpsonFindsTheSameOptimum) {
  Robot robot = testing::nomad();
  robot.power = {.standby_W = 5.0, .regeneration_efficiency = 1.0};
  const std::vector<PathPiece> pieces{straight_piece({}, 6.0),
                                      Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}),
                                      TurnInPlace{{}, 2.0}};
  for (const PathPiece& piece : pieces) {
    const double duration_s = is_turn(piece) ? 5.0 : 14.0;
    ProfileRequest request{
        .piece = piece, .plant = make_plant(robot), .limits = *robot.limits, .payload = {5, 5}};
    request.time = {TimeMode::fixed_time, duration_s};
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
    const double path_domain_J = replay(request, *result.profile).energy_J;
    const double time_domain_J =
        TimeDomain(request, duration_s).least_energy_J(piece_length(piece), duration_s);
    EXPECT_NEAR(path_domain_J, time_domain_J, 2e-4 * time_domain_J);
  }
}

}  // namespace
}  // namespace joulepath
