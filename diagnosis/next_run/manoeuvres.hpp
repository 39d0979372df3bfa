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
  double load{};                            ///< share of the greatest payload
};

/// Standing, driving both ways, spins, arcs, crawling, a fast run, hard starts: each at the robot's usual
/// pace, empty and with the greatest payload.
[[nodiscard]] std::vector<Manoeuvre> manoeuvre_library(const Robot& robot);

/// The same manoeuvre with one free parameter changed: slower, faster, longer, with less or more load, in the
/// other direction.
[[nodiscard]] std::vector<Manoeuvre> variants_of(const Manoeuvre& manoeuvre);

/// The manoeuvre's motions, slower where the limits require it. An arc of radius r at speed v has lateral
/// acceleration v^2/r, yaw rate v/r and yaw acceleration a/r.
[[nodiscard]] std::vector<PrescribedMotion> within(const Limits& limits,
                                                   std::vector<PrescribedMotion> motions);

}  // namespace joulepath
