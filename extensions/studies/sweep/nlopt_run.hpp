#pragma once

#include <exception>
#include <new>
#include <nlopt.hpp>
#include <optional>
#include <vector>

namespace joulepath {

/// Runs an optimizer from x until it ends or fails (rounding, a forced stop, any internal failure); x is then
/// the best point so far. Returns the value there, or nothing after a failure. Every caller improves a valid
/// point, so a failure only costs the improvement.
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
