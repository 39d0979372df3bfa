#pragma once

#include <exception>
#include <new>
#include <nlopt.hpp>
#include <optional>
#include <vector>

namespace joulepath {

/// Runs an optimizer from x to its end, or until it fails (rounding, a forced stop, any failure of its own):
/// x is the best point that it found until then. Returns the value there, none after a failure. Every caller
/// improves a point that is good already, so that a failure costs the improvement alone.
inline std::optional<double> optimize_as_far_as_possible(nlopt::opt& optimizer, std::vector<double>& x) {
  double value{};
  try {
    optimizer.optimize(x, value);
    return value;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace joulepath
