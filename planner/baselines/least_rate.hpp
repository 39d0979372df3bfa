#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace joulepath {

/// The least rate at which a time is kept, to `tolerance` of it: `excess_s(rate)` falls with the rate, is
/// above 0 at `slow` and not at `fast`. Never a rate that is too slow.
template <class Excess>
[[nodiscard]] double least_rate(const Excess& excess_s, double slow, double fast, double tolerance = 1e-13) {
  std::uintmax_t evaluations = 60;
  return boost::math::tools::toms748_solve(
             excess_s, slow, fast, [=](double low, double high) { return high - low <= tolerance * high; },
             evaluations)
      .second;
}

}  // namespace joulepath
