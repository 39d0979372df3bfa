#pragma once

#include "planner/joint/joint_problem.hpp"
#include "planner/nlp/interval/jet.hpp"

namespace joulepath::joint {

/// Displacement and turn from the start of a piece, in the frame there; derivatives by the piece's own
/// parameters (phi at both knots, length).
struct LocalPose {
  using Jet = nlp::JetOf<3>;
  Jet x{}, y{}, turn{};
};

/// Derivatives by the pose at the start of a piece (x, y, heading) and the piece's own parameters.
using PieceGradient = Eigen::Matrix<double, 6, 1>;
using PieceHessian = Eigen::Matrix<double, 6, 6>;
using PoseSlopes = Eigen::Matrix<double, 3, 6>;  ///< of x, y and heading

/// Of functions of poses on a piece: a gradient, one weighted by multipliers, and second derivatives.
struct PieceSums {
  PieceGradient gradient{PieceGradient::Zero()}, lagrangian{PieceGradient::Zero()};
  PieceHessian hessian{PieceHessian::Zero()};
};

/// Poses of a program's path for one set of parameters, with exact derivatives. A place on a piece depends on
/// the start of the piece and on its own parameters; a backward pass over the pieces brings the derivatives
/// by the starts to the parameters before them (condensing).
class PathGeometry {
 public:
  explicit PathGeometry(const Program& program) : program_(program) {}

  /// Poses alone.
  void place(const Eigen::VectorXd& parameters);
  /// Poses and derivatives.
  void differentiate(const Eigen::VectorXd& parameters);

  /// Pose at a share of a piece, in the program's frame.
  [[nodiscard]] Pose pose(std::size_t piece, double share) const;
  /// The same to about a millimetre, at half the cost.
  [[nodiscard]] Pose near_pose(std::size_t piece, double share) const;
  [[nodiscard]] double length_m(std::size_t piece) const;
  /// Turn per metre travelled, forward or backward (1/m), bounded where the robot turns in place.
  [[nodiscard]] double curvature_per_m(std::size_t piece, double share) const;
  [[nodiscard]] LocalPose local(std::size_t piece, double share) const;
  [[nodiscard]] PoseSlopes slopes(std::size_t piece, const LocalPose& local) const;
  /// Second derivatives of multiplier . pose of a place on a piece.
  [[nodiscard]] PieceHessian curvature(std::size_t piece, const LocalPose& local,
                                       const Eigen::Vector3d& multiplier) const;
  /// Gradients of x, y and heading [parameters x 3] of the end of a piece.
  [[nodiscard]] auto end_gradient(std::size_t piece) const {
    return starts_gradient_.middleCols<3>(3 * static_cast<Eigen::Index>(piece) + 3);
  }

  /// Errors of the targets: x, y and, where asked, heading of each.
  [[nodiscard]] Eigen::VectorXd errors() const;
  [[nodiscard]] Eigen::MatrixXd error_gradient() const;  ///< [errors x parameters]

  /// Mean square of the displacement of the pieces' ends (m^2) as a quadratic form of the parameters.
  [[nodiscard]] Eigen::MatrixXd displacement_metric() const;

  /// Sums of a piece, to be filled between differentiate() and add_sums().
  [[nodiscard]] PieceSums& sums(std::size_t piece) { return sums_[piece]; }
  /// Adds the pieces' sums to those of the parameters; the targets' multipliers belong to `lagrangian`.
  void add_sums(const Eigen::VectorXd& target_multipliers, Eigen::VectorXd& gradient,
                Eigen::VectorXd& lagrangian, Eigen::MatrixXd& hessian) const;

  /// First-order changes of the start poses and own parameters of the pieces.
  [[nodiscard]] std::vector<PieceGradient> changes(const Eigen::VectorXd& parameters) const;

 private:
  std::array<Eigen::Index, 3> own(std::size_t piece) const;
  void add_condensed(const std::vector<PieceHessian>& pieces, const Eigen::Matrix3d& end,
                     Eigen::MatrixXd& hessian) const;

  const Program& program_;
  const Eigen::VectorXd* parameters_{};
  std::vector<Pose> starts_{};          ///< of the pieces, and the end
  std::vector<LocalPose> whole_{};      ///< of the pieces
  std::vector<PoseSlopes> whole_by_{};  ///< of the pieces' ends
  Eigen::MatrixXd starts_gradient_{};   ///< of the starts [parameters x 3 (pieces + 1)]
  std::vector<PieceSums> sums_{};
};

}  // namespace joulepath::joint
