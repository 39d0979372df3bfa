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

/// A multiplier of a pose on the path: of its place and heading.
struct PoseMultiplier {
  double x{}, y{}, heading{};
};

/// Poses of a program's path for one set of parameters, with exact derivatives. Second derivatives are
/// contracted with multipliers: each piece receives the sum of the multipliers behind it, so that they cost
/// no more than the first ones.
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
  /// Gradients of x, y and heading [parameters x 3] of a pose on a piece.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 3> gradient(std::size_t piece,
                                                                  const LocalPose& local) const;

  /// Errors of the targets: x, y and, where asked, heading of each.
  [[nodiscard]] Eigen::VectorXd errors() const;
  [[nodiscard]] Eigen::MatrixXd error_gradient() const;  ///< [errors x parameters]

  /// Mean square of the displacement of the pieces' ends (m^2) as a quadratic form of the parameters.
  [[nodiscard]] Eigen::MatrixXd displacement_metric() const;

  /// Adds the second derivative of multiplier . pose of a place on a piece to `hessian`.
  void add_curvature(std::size_t piece, const LocalPose& local, const PoseMultiplier& multiplier,
                     Eigen::MatrixXd& hessian);
  /// The same for the targets; then adds what all multipliers so far bend in the pieces before them. To be
  /// called last, once.
  void finish_curvature(const Eigen::VectorXd& target_multipliers, Eigen::MatrixXd& hessian);

 private:
  std::array<Eigen::Index, 3> own(std::size_t piece) const;
  double add_own_curvature(std::size_t piece, const LocalPose& local, double lx, double ly,
                           Eigen::MatrixXd& hessian) const;

  const Program& program_;
  const Eigen::VectorXd* parameters_{};
  std::vector<Pose> starts_{};                ///< of the pieces, and the end
  std::vector<LocalPose> whole_{};            ///< of the pieces
  Eigen::MatrixXd dx_{}, dy_{}, dheading_{};  ///< of the starts [parameters x pieces + 1]
  std::vector<PoseMultiplier> behind_{};      ///< sums of multipliers of places in each piece
  std::vector<double> turned_by_{};           ///< of the piece's own heading, by its places
};

}  // namespace joulepath::joint
