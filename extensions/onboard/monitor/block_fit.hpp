#pragma once

#include <Eigen/Core>

#include "extensions/onboard/monitor/signatures.hpp"

namespace joulepath {

/// An estimate and its 1-sigma.
struct Estimate {
  double value{};
  double sigma{};
};

/// What a block of windows says about the causes of its residuals.
struct BlockEstimate {
  double begin_s{};
  double end_s{};
  Estimate extra_kg{};      ///< beyond the stated payload, all other causes free within their priors
  Estimate disagreement{};  ///< kg seen while driving less kg seen while braking
  Estimate resistance{};    ///< as a share of the nominal dry friction, payload free
  double noise{};           ///< 1-sigma of a row, as used
};

/// Least squares over a block of windows: normal equations only, so that its memory is constant.
class BlockFit {
 public:
  explicit BlockFit(std::size_t others) { reset(others); }

  void add(const WindowMean& window, const WindowEquations& rows);
  [[nodiscard]] std::size_t windows() const { return windows_; }
  [[nodiscard]] double begin_s() const { return begin_s_; }
  [[nodiscard]] double end_s() const { return end_s_; }
  /// Sum of squares that all causes leave, and the rows less the causes.
  struct Leftover {
    double squares{}, freedom{};
  };
  [[nodiscard]] Leftover leftover() const;
  [[nodiscard]] BlockEstimate estimate(double noise) const;
  /// The other cause that alone explains most; below 0: none explains more than payload alone.
  [[nodiscard]] int best_other() const;
  void reset(std::size_t others);

 private:
  // Columns: kg while driving, kg while braking, resistance, then the other causes.
  static constexpr Eigen::Index kDriving = 0, kBraking = 1, kResistance = 2, kOther = 3;
  [[nodiscard]] Eigen::MatrixXd with_priors(double noise) const;

  Eigen::MatrixXd normal_{};
  Eigen::VectorXd right_{};
  double squares_{}, rows_{}, begin_s_{}, end_s_{};
  std::size_t windows_{};
};

}  // namespace joulepath
