#pragma once

#include <string>

namespace joulepath {

/// The result of an independent integration of a profile.
struct ReplayResult {
  double energy_J{};         ///< at the battery's terminals, standby included
  double motion_energy_J{};  ///< without standby
  double duration_s{};
  double end_s{};            ///< where the integration ended
  double worst_violation{};  ///< relative: value/limit - 1, never below 0
  std::string limit{};       ///< the limit violated worst, a key of Limits without its unit, or path: it
                             ///< ends elsewhere; empty if none
  double s{};                ///< where
  double x_m{};
  double y_m{};

  bool valid(double tolerance = 1e-6) const { return worst_violation <= tolerance; }
};

}  // namespace joulepath
