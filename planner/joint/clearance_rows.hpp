#pragma once

#include <vector>

#include "planner/joint/interior_rows.hpp"
#include "planner/joint/path_geometry.hpp"

namespace joulepath::joint {

/// Clearance of the footprint at the nodes of a program: one inequality per node, its derivatives from those
/// of the floor's distance.
class ClearanceRows {
 public:
  explicit ClearanceRows(const Program& program) : program_(program) {}
  void lay_out();

  /// Slack (m) beyond the margin at each node, exact up to a tenth of a metre and never more.
  [[nodiscard]] std::vector<double> values(const PathGeometry& geometry) const;
  [[nodiscard]] std::vector<double> present() const;

  struct Blocks {
    Eigen::VectorXd &gradient, &lagrangian;
    Eigen::MatrixXd& hessian;
  };
  struct Sums {
    double complementarity{}, primal{};
  };
  void begin(const std::vector<double>& values, double mu);
  Sums assemble(PathGeometry& geometry, double mu, const Blocks& blocks);
  void step(const Eigen::VectorXd& change, double mu, StepLengths& lengths);
  double merit(const std::vector<double>& values, double step, double mu) const;
  void take(const std::vector<double>& values, double primal, double dual, double mu);

 private:
  struct Node {
    std::size_t piece{};
    double share{};
    Row row{};
    Eigen::VectorXd gradient{};  ///< empty: far from every obstacle
  };
  struct Slopes {
    double x{}, y{}, heading{};  ///< in the program's frame
    double bend{};               ///< second derivative across the gradient
  };
  double slack_m(const Pose& pose) const;
  Slopes slopes(const Pose& pose, double here_m) const;
  void add(Node& node, PathGeometry& geometry, double mu, const Blocks& blocks);

  const Program& program_;
  std::vector<Node> nodes_{};
};

}  // namespace joulepath::joint
