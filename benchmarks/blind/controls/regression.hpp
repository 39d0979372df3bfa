#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace control {

/// Normal equations of a weighted least-squares problem, gathered row by row.
class Regression {
 public:
  explicit Regression(std::size_t columns) : n_(columns), gram_(columns * columns), moment_(columns) {}

  void add(const std::vector<double>& row, double target, double weight) {
    for (std::size_t i = 0; i < n_; ++i) {
      if (row[i] == 0) continue;
      moment_[i] += weight * row[i] * target;
      for (std::size_t j = 0; j <= i; ++j) gram_[i * n_ + j] += weight * row[i] * row[j];
    }
    target_square_ += weight * target * target;
  }

  double norm(std::size_t i) const { return std::sqrt(gram_[i * n_ + i]); }
  double target_norm() const { return std::sqrt(target_square_); }

  /// Coefficients with only the columns of `active`; the others are 0. `ridge` is relative to each column's
  /// norm.
  std::vector<double> solve(const std::vector<bool>& active, double ridge = 1e-8) const {
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < n_; ++i)
      if (active[i] && norm(i) > 0) index.push_back(i);
    const std::size_t m = index.size();
    std::vector<double> l(m * m), y(m), out(n_, 0.0);
    const auto entry = [&](std::size_t a, std::size_t b) {  // scaled to unit diagonal
      const std::size_t i = index[a], j = index[b];
      return (i >= j ? gram_[i * n_ + j] : gram_[j * n_ + i]) / (norm(i) * norm(j)) + (a == b ? ridge : 0.0);
    };
    for (std::size_t a = 0; a < m; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        double sum = entry(a, b);
        for (std::size_t c = 0; c < b; ++c) sum -= l[a * m + c] * l[b * m + c];
        l[a * m + b] = a == b ? std::sqrt(std::fmax(sum, 1e-14)) : sum / l[b * m + b];
      }
      y[a] = moment_[index[a]] / norm(index[a]);
      for (std::size_t c = 0; c < a; ++c) y[a] -= l[a * m + c] * y[c];
      y[a] /= l[a * m + a];
    }
    for (std::size_t a = m; a-- > 0;) {
      for (std::size_t c = a + 1; c < m; ++c) y[a] -= l[c * m + a] * y[c];
      y[a] /= l[a * m + a];
      out[index[a]] = y[a] / norm(index[a]);
    }
    return out;
  }

  /// Sum of squares left over by these coefficients.
  double rest(const std::vector<double>& x) const {
    double value = target_square_;
    for (std::size_t i = 0; i < n_; ++i) {
      if (x[i] == 0) continue;
      value -= 2 * x[i] * moment_[i];
      for (std::size_t j = 0; j < n_; ++j)
        value += x[i] * x[j] * (i >= j ? gram_[i * n_ + j] : gram_[j * n_ + i]);
    }
    return value;
  }

 private:
  std::size_t n_;
  std::vector<double> gram_, moment_;
  double target_square_{};
};

}  // namespace control
