#include <algorithm>
#include <cmath>

#include "model/simulation/drive_forces.hpp"
// Design: docs/decisions/0102-simulation.md
// Method: [Karnopp1985]
namespace joulepath {

/// Bounds of friction on the surfaces that hold: its values for sliding either way, at zero speed.
void Drive::bounds(const DriveState& state, Site site, const FrictionMode& mode, Forces& forces) const {
  const Site held = site;
  const auto set = [&](Surface surface, double backward, double forward) {
    forces.low[surface] = std::min(backward, 0.0);
    forces.high[surface] = std::max(forward, 0.0);
  };
  for (Side side : kSides) {
    if (mode[surface_of(side)] != 0) continue;
    const auto sliding_Nm = [&](double direction) {
      site.wheel_direction[side] = direction;
      return shaft_friction_Nm(plant_, mass_, side, 0.0, site) +
             plant_.torque_loss_fraction * std::abs(forces.motor_Nm[side]) * direction;
    };
    set(surface_of(side), sliding_Nm(-1), sliding_Nm(1));
    site = held;
  }
  const double v = state[kVelocity + kTravel];
  const double omega = state[kVelocity + kTurn];
  if (active_[kTurn] && mode[kTurn] == 0) {
    const auto sliding_Nm = [&](double direction) {
      site.turn_direction = direction;
      return effect_load(plant_, mass_, v, omega, site).moment_Nm - forces.load.moment_Nm;
    };
    set(kTurn, sliding_Nm(-1), sliding_Nm(1));
    site = held;
  }
  if (active_[kTravel] && mode[kTravel] == 0) {
    const auto sliding_N = [&](double direction) {
      site.travel_direction = direction;
      return effect_load(plant_, mass_, v, omega, site).force_N - forces.load.force_N;
    };
    set(kTravel, sliding_N(-1), sliding_N(1));
  }
}

/// Finds reactions within their bounds that keep the holding surfaces at rest. A surface that needs a larger
/// reaction gets the bound and breaks away.
void Drive::hold(const FrictionMode& mode, Forces& forces, Velocity& acceleration, Instant& instant) const {
  Velocity reaction{};
  acceleration = respond(forces.total);
  constexpr int kSweeps = 200;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0;
    for (Surface s : kAllSurfaces) {
      if (mode[s] != 0 || !active_[s]) continue;
      const double wanted = reaction[s] + acceleration[s] / response_[s][s];
      const double change = std::clamp(wanted, forces.low[s], forces.high[s]) - reaction[s];
      reaction[s] += change;
      for (std::size_t a = 0; a < kSurfaces; ++a) acceleration[a] -= response_[a][s] * change;
      moved = std::max(moved, std::abs(change));
    }
    if (moved < 1e-13) break;
  }
  for (Surface s : kAllSurfaces) {
    if (mode[s] != 0 || !active_[s]) continue;
    const bool at_bound = reaction[s] <= forces.low[s] || reaction[s] >= forces.high[s];
    if (at_bound && std::abs(acceleration[s]) > 1e-9) instant.release[s] = acceleration[s] > 0 ? 1 : -1;
    if (!at_bound) acceleration[s] = 0.0;
  }
  if (!creeps_) {  // the body's speeds follow from the wheels exactly
    const Sided<double> wheels{acceleration[kLeftWheel], acceleration[kRightWheel]};
    const Twist<double> body = body_twist(plant_.robot.geometry, wheels);
    acceleration[kTravel] = body.speed_m_s;
    acceleration[kTurn] = body.yaw_rate_rad_s;
  }
  for (Side side : kSides) forces.friction_Nm[side] += reaction[surface_of(side)];
  forces.load.force_N += reaction[kTravel];
  forces.load.moment_Nm += reaction[kTurn];
}

}  // namespace joulepath
