#pragma once

#include "model/energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/values/profile.hpp"

namespace joulepath {

/// Power (W) that the drives take from the supply at a state, standby left out.
[[nodiscard]] double drive_power_W(const PathMotion& motion, const ProfileState& state);

/// Energy (J) at the battery's terminals over segment k of a profile, standby left out, by quadrature on
/// the exact path, split where a motor's power changes its sign.
[[nodiscard]] double segment_energy_J(const PathMotion& motion, const Profile& profile, std::size_t k);

/// Joules by cause between two instants of a profile, waiting at its end included. Intervals that follow on
/// each other add up to the whole.
[[nodiscard]] EnergyByCause energy_between(const PathMotion& motion, const Profile& profile, double from_s,
                                           double to_s);

/// Dense quadrature of power_by_cause() along a profile (Gauss-Legendre within each segment, split where
/// the power changes its sign).
[[nodiscard]] EnergyByCause energy_by_cause(const PathMotion& motion, const Profile& profile);

}  // namespace joulepath
