#pragma once

#include <cstddef>

#include "diagnosis/checks/relations.hpp"

namespace joulepath {

/// Effect of a repair on the relations of a run.
struct Effectiveness {
  double nats{};       ///< sum over the relations of log(unexplained share before / after)
  bool repairs{};      ///< the repair makes a relation sound and harms none
  bool contradicts{};  ///< the repair breaks a sound relation
  std::size_t most{};  ///< relation with the greatest gain
};

/// With `by_factor` (a factor that is not a unit conversion), relations that predict torques do not count:
/// resistances of the floor may multiply the torque several times.
[[nodiscard]] Effectiveness compare(const Relations& before, const Relations& after, bool by_factor = false);

}  // namespace joulepath
