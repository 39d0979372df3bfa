#pragma once

#include <Eigen/Core>
#include <cmath>

namespace joulepath {

/// Root of the mean square; 0 without values.
[[nodiscard]] inline double rms(const Eigen::VectorXd& values) {
  return values.size() > 0 ? std::sqrt(values.squaredNorm() / static_cast<double>(values.size())) : 0.0;
}

}  // namespace joulepath
