#pragma once

#include <cstddef>
#include <vector>

namespace joulepath::nlp {

/// Symmetric tridiagonal matrix: `diagonal` and `below` (one shorter), factored as L D L^T in place.
struct Tridiagonal {
  std::vector<double> diagonal{};
  std::vector<double> below{};

  explicit Tridiagonal(std::size_t n = 0) { resize(n); }

  void reserve(std::size_t n) {
    diagonal.reserve(n);
    below.reserve(n);
  }
  /// All zeros.
  void resize(std::size_t n) {
    diagonal.assign(n, 0.0);
    below.assign(n > 0 ? n - 1 : 0, 0.0);
  }

  /// False if a pivot is not positive: the matrix is not positive definite.
  [[nodiscard]] bool factor() {
    for (std::size_t i = 0; i < diagonal.size(); ++i) {
      if (!(diagonal[i] > 0)) return false;
      if (i + 1 == diagonal.size()) break;
      const double ratio = below[i] / diagonal[i];
      diagonal[i + 1] -= ratio * below[i];
      below[i] = ratio;
    }
    return true;
  }

  /// Solves with the factors; x is the right side, then the solution.
  void solve(std::vector<double>& x) const {
    const std::size_t n = diagonal.size();
    for (std::size_t i = 1; i < n; ++i) x[i] -= below[i - 1] * x[i - 1];
    for (std::size_t i = 0; i < n; ++i) x[i] /= diagonal[i];
    for (std::size_t i = n - 1; i-- > 0;) x[i] -= below[i] * x[i + 1];
  }
};

}  // namespace joulepath::nlp
