#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "planner/joint/regularized_step.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
// Method: [NocedalWright2006]
namespace joulepath::joint {

/// A vector with an entry for each unknown.
struct UnknownVector {
  Eigen::VectorXd squares{};     ///< of the rate, (dtau/dt)^2
  Eigen::VectorXd parameters{};  ///< of the path, see Program
};

/// The Newton system of path and speed,
///     [T  B  0 ]   [squares    ]     [g of the squares   ]
///     [B' H  A'] * [parameters ] = - [g of the parameters]
///     [0  A  0 ]   [multipliers]     [errors             ].
/// A part of the path joins the squares at its two ends and its three parameters, so that T is tridiagonal.
class BorderedSystem {
 public:
  /// Unknowns of a part: squares (-1: at rest), and parameters.
  struct Part {
    std::array<Eigen::Index, 2> squares{-1, -1};
    std::array<Eigen::Index, 3> parameters{};
  };
  static constexpr std::size_t kPartUnknowns = 5;

  BorderedSystem() = default;
  BorderedSystem(std::vector<Part> parts, Eigen::Index squares, Eigen::Index parameters);

  /// Zeros, for another sum of parts and rows.
  void clear();
  /// Adds a part's gradient g, its share of the Lagrangian's gradient and its Hessian (lower triangle by
  /// rows).
  void add(std::size_t part, const std::array<double, kPartUnknowns>& of_g,
           const std::array<double, kPartUnknowns>& of_lagrangian,
           const std::array<double, kPartUnknowns*(kPartUnknowns + 1) / 2>& hessian);
  /// The same of a bound of one square or parameter.
  void add_bound(bool of_square, Eigen::Index at, double of_g, double of_lagrangian, double hessian);
  /// Takes parameters that do not move out of the system.
  void hold(const std::vector<Eigen::Index>& held);

  /// Solves for the step of the parameters and the multipliers: the squares are eliminated, the rest is
  /// solved in the null space of A ([NocedalWright2006], 16.2). H has a weight of the metric, which counts
  /// from the shortest step to the targets on.
  void solve(double regularization);
  /// The step of the squares that belongs to that of the parameters.
  void follow();
  /// The shortest step of the parameters that changes the linearized targets by `change`.
  [[nodiscard]] Eigen::VectorXd to_targets(const Eigen::VectorXd& change) const;

  UnknownVector g{}, lagrangian{};      ///< gradients: of the barrier's problem, and of the Lagrangian
  Eigen::MatrixXd hessian{}, metric{};  ///< H; of the regularization [parameters x parameters]
  Eigen::MatrixXd targets{};            ///< A [errors x parameters]
  Eigen::VectorXd errors{};             ///< of the targets
  UnknownVector step{};
  Eigen::VectorXd multipliers{};

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  template <class Each>
  void for_border(const Each& each) const;
  void factorize_squares();
  void eliminate_squares();

  std::vector<Part> parts_{};
  Eigen::VectorXd diagonal_{}, beside_{};              ///< of T
  std::vector<Eigen::Matrix<double, 2, 3>> border_{};  ///< B, by parts
  Eigen::VectorXd pivot_{}, lower_{};
  RowMajor eliminated_{};  ///< T^-1 [B g]
  Eigen::MatrixXd range_{};
  Eigen::PartialPivLU<Eigen::MatrixXd> on_range_{};
};

}  // namespace joulepath::joint
