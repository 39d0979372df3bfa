#include "diagnosis/checks/box_fit.hpp"

#include <algorithm>

namespace joulepath {
namespace {

constexpr int kSweeps = 400;

}  // namespace

BoxFit fit_in_box(const Eigen::VectorXd& explained, const std::vector<BoxedTerm>& terms) {
  const auto n = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd columns(explained.size(), n);
  for (Eigen::Index k = 0; k < n; ++k) columns.col(k) = terms[static_cast<std::size_t>(k)].value;
  const Eigen::MatrixXd gram = columns.transpose() * columns;
  const Eigen::VectorXd image = columns.transpose() * explained;
  BoxFit fit{.coefficient = Eigen::VectorXd::Zero(n)};
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (Eigen::Index k = 0; k < n; ++k) {
      const BoxedTerm& term = terms[static_cast<std::size_t>(k)];
      const double rest = image[k] - gram.row(k).dot(fit.coefficient) + gram(k, k) * fit.coefficient[k];
      const double best = gram(k, k) > 0 ? rest / gram(k, k) : 0.0;
      fit.coefficient[k] = std::clamp(best, term.least, term.most);
    }
  const double all = explained.squaredNorm();
  fit.unexplained = all > 0 ? (explained - columns * fit.coefficient).squaredNorm() / all : 0.0;
  return fit;
}

}  // namespace joulepath
