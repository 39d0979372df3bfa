#include "box_fit.hpp"

namespace blind {

Matrix combined(const Matrix& gram, const std::vector<Combination>& wanted) {
  Matrix out(wanted.size(), Vector(wanted.size()));
  for (std::size_t i = 0; i < wanted.size(); ++i)
    for (std::size_t j = 0; j < wanted.size(); ++j)
      for (const auto& [p, left] : wanted[i])
        for (const auto& [q, right] : wanted[j]) out[i][j] += left * right * gram[p][q];
  return out;
}

Vector solved(Matrix a, Vector b) {
  const std::size_t n = b.size();
  std::vector<bool> used(n, false);
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = a[k][k];
    if (!(pivot > 1e-12)) continue;
    used[k] = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / pivot;
      for (std::size_t j = 0; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) b[k] = used[k] ? b[k] / a[k][k] : 0.0;
  return b;
}

Fit boxed(const Matrix& gram, const Vector& least, const Vector& most) {
  const std::size_t n = least.size();
  std::size_t combinations = 1;
  for (std::size_t k = 0; k < n; ++k) combinations *= 3;
  Fit best;
  for (std::size_t which = 0; which < combinations; ++which) {
    Vector a(n);
    std::vector<std::size_t> free;
    std::size_t digits = which;
    for (std::size_t k = 0; k < n; ++k, digits /= 3) {
      if (digits % 3 == 0) free.push_back(k);
      a[k] = digits % 3 == 1 ? least[k] : (digits % 3 == 2 ? most[k] : 0.0);
    }
    Matrix system(free.size(), Vector(free.size()));
    Vector right(free.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
      right[i] = gram[0][free[i] + 1];
      for (std::size_t k = 0; k < n; ++k) right[i] -= gram[free[i] + 1][k + 1] * a[k];
      for (std::size_t j = 0; j < free.size(); ++j) system[i][j] = gram[free[i] + 1][free[j] + 1];
    }
    const Vector step = solved(system, right);
    bool inside = true;
    for (std::size_t i = 0; i < free.size(); ++i) {
      a[free[i]] = step[i];
      inside = inside && step[i] >= least[free[i]] && step[i] <= most[free[i]];
    }
    if (!inside) continue;
    double value = gram[0][0];
    for (std::size_t i = 0; i < n; ++i) {
      value -= 2 * a[i] * gram[0][i + 1];
      for (std::size_t j = 0; j < n; ++j) value += a[i] * a[j] * gram[i + 1][j + 1];
    }
    if (value < best.value) best = {value, a};
  }
  return best;
}

}  // namespace blind
