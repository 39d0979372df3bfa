#pragma once

#include <Eigen/Core>
#include <vector>

namespace joulepath {

/// One term of a relation between channels: its values, and the range of coefficients that a sound log may
/// have.
struct BoxedTerm {
  Eigen::VectorXd value{};
  double least{};
  double most{};
};

struct BoxFit {
  Eigen::VectorXd coefficient{};
  double unexplained{1.0};  ///< residual sum of squares over the sum of squares of the explained values
};

/// Least squares with every coefficient inside its box, by coordinate descent (a convex problem).
[[nodiscard]] BoxFit fit_in_box(const Eigen::VectorXd& explained, const std::vector<BoxedTerm>& terms);

}  // namespace joulepath
