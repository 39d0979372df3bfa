#pragma once

#include <string>
#include <vector>

#include "model/prescribed_motion.hpp"
#include "model/robot.hpp"

namespace joulepath {

/// A safe manoeuvre and its purpose.
struct Manoeuvre {
  std::string why{};
  std::vector<PrescribedMotion> motions{};  ///< one after the other
  std::vector<double> loads{};              ///< of each motion: share of the greatest payload
};

/// Standing, driving both ways, spins, arcs, crawling, a fast run, hard starts: each at the robot's usual
/// pace, empty, with the greatest payload, and first the one, then the other: friction is the same in both
/// parts.
[[nodiscard]] std::vector<Manoeuvre> manoeuvre_library(const Robot& robot);

/// The same manoeuvre with one free parameter changed: slower, faster, longer, with less or more load, in the
/// other direction.
[[nodiscard]] std::vector<Manoeuvre> variants_of(const Manoeuvre& manoeuvre);

/// A motion, slower where the limits require it. An arc of radius r at speed v has lateral
/// acceleration v^2/r, yaw rate v/r and yaw acceleration a/r.
[[nodiscard]] PrescribedMotion within(const Limits& limits, PrescribedMotion motion);

}  // namespace joulepath
