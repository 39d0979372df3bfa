#pragma once

#include <Eigen/Core>
#include <vector>

namespace joulepath {

/// One term of a relation between channels: what it reads, and the coefficients that a sound log may have.
struct BoxedTerm {
  Eigen::VectorXd value{};
  double least{};
  double most{};
};

struct BoxFit {
  Eigen::VectorXd coefficient{};
  double unexplained{1.0};  ///< residual sum of squares over the sum of squares of what is explained
};

/// Least squares with every coefficient inside its box, by coordinate descent (the problem is convex).
[[nodiscard]] BoxFit fit_in_box(const Eigen::VectorXd& explained, const std::vector<BoxedTerm>& terms);

}  // namespace joulepath
