#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace joulepath {

/// The least rate at which a time is kept, to 1e-13 of it: `excess_s(rate)` falls with the rate, is above 0
/// at `slow` and not at `fast`. Never a rate that is too slow.
template <class Excess>
[[nodiscard]] double least_rate(const Excess& excess_s, double slow, double fast) {
  constexpr double kTolerance = 1e-13;
  std::uintmax_t evaluations = 60;
  return boost::math::tools::toms748_solve(
             excess_s, slow, fast, [](double low, double high) { return high - low <= kTolerance * high; },
             evaluations)
      .second;
}

}  // namespace joulepath
