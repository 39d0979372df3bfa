#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "signals.hpp"

namespace blind {

/// A linear combination of columns.
using Combination = std::vector<std::pair<std::size_t, double>>;

/// The Gram matrix of these combinations of its columns.
[[nodiscard]] Matrix combined(const Matrix& gram, const std::vector<Combination>& wanted);

/// Solve A x = b by Gauss-Jordan; a direction without a pivot stays 0.
[[nodiscard]] Vector solved(Matrix a, Vector b);

struct Fit {
  double value{std::numeric_limits<double>::infinity()};
  Vector amplitude{};
};

/// Least |d - sum a_j x_j|^2 within least <= a <= most; d is the Gram matrix's first direction. Few columns:
/// each is tried free, at its least and at its most.
[[nodiscard]] Fit boxed(const Matrix& gram, const Vector& least, const Vector& most);

}  // namespace blind
