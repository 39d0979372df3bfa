#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace joulepath {

inline constexpr double kSureSigmas = 5.0;  ///< of a least-squares fit whose errors are not white

/// Normal equations of a few coefficients.
template <int N>
class SmallFit {
 public:
  using Row = Eigen::Matrix<double, N, 1>;

  void add(const Row& row, double value) {
    gram_ += row * row.transpose(), right_ += row * value, square_ += value * value, ++count_;
  }

  /// The first `K` coefficients with their standard errors; false where the rows do not determine them.
  template <std::size_t K>
  bool solve(std::array<double, K>& value, std::array<double, K>& error) const {
    if (count_ < 10 + N) return false;
    const Eigen::LDLT<Eigen::Matrix<double, N, N>> solved(gram_);
    if (!solved.isPositive() || solved.rcond() < 1e-12) return false;
    const Row fit = solved.solve(right_);
    const Eigen::Matrix<double, N, N> inverse = solved.solve(Eigen::Matrix<double, N, N>::Identity());
    const double variance = std::max(0.0, square_ - fit.dot(right_)) / static_cast<double>(count_ - N);
    for (std::size_t k = 0; k < K; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      value[k] = fit[at], error[k] = std::sqrt(variance * inverse(at, at));
    }
    return true;
  }

 private:
  Eigen::Matrix<double, N, N> gram_{Eigen::Matrix<double, N, N>::Zero()};
  Row right_{Row::Zero()};
  double square_{};
  int count_{};
};

}  // namespace joulepath
