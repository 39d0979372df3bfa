#pragma once

#include <map>
#include <string>

namespace joulepath {

/// Why no profile exists: the limit that prevents it, where, by how much, and the smallest
/// change found that would make it possible.
struct Infeasibility {
  std::string constraint{};  ///< a key of Limits without its unit, or deadline, duration, start_speed,
                             ///< end_speed, path
  double s{};                ///< path coordinate: arc length in m, or rad turned in place
  double x_m{};
  double y_m{};
  double amount{};  ///< by which the limit is missed, in `unit`
  std::string unit{};
  std::map<std::string, double> relaxation{};  ///< key -> smallest change that works, one key
  std::string message{};                       ///< one sentence for people
};

}  // namespace joulepath
