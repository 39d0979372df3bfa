#include "benchmarks/problems/generator.hpp"

#include <cmath>

#include "model/limit_table.hpp"

namespace joulepath::problems {
namespace {

/// Rounds, so that a file needs few digits and parses back to the same problem.
double rounded(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace

Knots Generator::straight() { return {{0, rounded(uniform(1, 40))}, {0, 0}}; }

/// A cubic Bezier curve's curvature at 25 knots.
Knots Generator::bend(double scale) {
  const double size = scale * uniform(2, 10), turn = uniform(-1.6, 1.6), reach = size * uniform(0.3, 0.5);
  const double x = size * std::cos(turn / 2), y = size * std::sin(turn / 2);
  const BezierSegment curve(
      {{{0, 0}, {reach, 0}, {x - reach * std::cos(turn), y - reach * std::sin(turn)}, {x, y}}});
  Knots knots;
  for (int k = 0; k <= 24; ++k) {
    const double s_m = curve.length_m() * k / 24;
    knots.s_m.push_back(rounded(s_m));
    knots.curvature_per_m.push_back(rounded(curve.at(s_m).curvature_per_m));
  }
  return knots;
}

/// Straights joined by clothoid pairs: curvature rises linearly to 1/radius and falls again.
Knots Generator::corners(double radius_m) {
  Knots knots{{0}, {0}};
  const auto append = [&](double length_m, double curvature_per_m) {
    knots.s_m.push_back(rounded(knots.s_m.back() + length_m));
    knots.curvature_per_m.push_back(rounded(curvature_per_m));
  };
  append(uniform(0.5, 5), 0);
  const std::size_t count = 1 + choice(4);
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = (choice(2) == 0 ? 1 : -1) * uniform(0.4, 1.6);
    append(std::abs(turn) * radius_m, std::copysign(1 / radius_m, turn));
    append(std::abs(turn) * radius_m, 0);
    append(uniform(0.5, 5), 0);
  }
  return knots;
}

void Generator::vary_limits(Limits& limits) {
  for (double Limits::*limit :
       {&Limits::speed_m_s, &Limits::acceleration_m_s2, &Limits::deceleration_m_s2,
        &Limits::lateral_acceleration_m_s2, &Limits::yaw_rate_rad_s, &Limits::yaw_acceleration_rad_s2})
    limits.*limit = rounded(limits.*limit * uniform(0.6, 1.2));
}

PathPiece Generator::turn() {
  return TurnInPlace{{}, (choice(2) == 0 ? 1 : -1) * rounded(uniform(0.2, 3.1))};
}

Problem Generator::next(std::size_t index, Part part) {
  const std::size_t kind = part == Part::jerk ? index % 3 : index % 4;  // no tight corners under a jerk limit
  Robot robot = robots_[(index / 4) % robots_.size()];
  const double eta[] = {0, 0.6, 1}, standby_share[] = {0, 0.5, 1, 2};
  robot.power.standby_W *= standby_share[choice(4)];
  robot.power.regeneration_efficiency = eta[choice(3)];
  robot.power.sharing = choice(2) == 0 ? PowerSharing::wheel : PowerSharing::bus;
  const double payload_kg = rounded(uniform(0, 0.9) * robot.limits->max_payload_kg);
  Limits limits = limits_for_payload(robot, payload_kg);
  limits.jerk_m_s3 = part == Part::jerk ? rounded(uniform(0.3, 1.5)) : kNoLimit;
  vary_limits(limits);
  // Half the track of the smallest robot, 0.165 m, is the unit: the inner wheel reverses in tight corners.
  const double scale = robot.geometry.half_track_m / 0.165;
  const PathPiece piece = part == Part::turns ? turn()
                          : kind == 0         ? curve_through(straight())
                          : kind == 1         ? curve_through(bend(scale))
                          : kind == 2         ? curve_through(corners(scale * uniform(0.4, 1.5)))
                                              : curve_through(corners(scale * uniform(0.09, 0.16)));
  return {.kind = part == Part::turns ? kTurn : kKinds[kind],
          .robot_name = robot.name,
          .request = {.piece = piece,
                      .plant = make_plant(robot),
                      .limits = limits,
                      .payload = {payload_kg, payload_kg},
                      .time = {TimeMode::minimum_time},
                      .solver = SolverChoice::fast}};
}

}  // namespace joulepath::problems
