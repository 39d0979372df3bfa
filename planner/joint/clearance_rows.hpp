#pragma once

#include <vector>

#include "planner/joint/interior_rows.hpp"
#include "planner/joint/path_geometry.hpp"

namespace joulepath::joint {

/// Clearance of the footprint along a program's pieces: one inequality per part of a piece, at the place of
/// the part that has the least. Such a place moves with the path: the second derivatives know it, as rows at
/// fixed places would hold the path to steps of their distance.
class ClearanceRows {
 public:
  explicit ClearanceRows(const Program& program) : program_(program) {}
  void lay_out(const Eigen::VectorXd& parameters);

  struct Place {
    std::size_t piece{};
    double share{};
  };
  /// The place of a part with the least slack beyond the margin, exact up to a tenth of a metre and never
  /// more.
  struct Nearest {
    Place place{};
    double slack_m{};
    bool inside{};  ///< of the part: not at an end
  };
  [[nodiscard]] std::vector<Nearest> nearest(const PathGeometry& geometry) const;
  [[nodiscard]] std::vector<Nearest> present() const;

  struct Sums {
    double complementarity{}, primal{};
    bool lost{};               ///< the distance at a place without clearance has no slope
    double least_m{kNoLimit};  ///< of the rows' slacks
  };
  void begin(const std::vector<Nearest>& nearest, double mu);
  /// Adds to the sums of the geometry's pieces, which stands where the present places were found.
  Sums assemble(PathGeometry& geometry, double mu);
  void step(const std::vector<PieceGradient>& changes, double mu, StepLengths& lengths);
  double merit(const std::vector<Nearest>& nearest, double step, double mu) const;
  void take(const std::vector<Nearest>& nearest, double primal, double dual, double mu);

 private:
  struct Part {
    std::size_t piece{};
    double from{}, to{};  ///< shares of the piece, that of a neighbor below 0 and above 1
    Row row{};
    Nearest at{};
    PieceGradient gradient = PieceGradient::Zero();  ///< zero: far from every obstacle
  };
  Place place(const PathGeometry& geometry, std::size_t piece, double share) const;
  Nearest nearest(const PathGeometry& geometry, const Part& part) const;
  struct Slopes {
    double x{}, y{}, heading{};  ///< in the program's frame
    double bend{};               ///< second derivative across the gradient
  };
  bool leaves_stop(std::size_t piece) const;
  bool reaches_stop(std::size_t piece) const;
  double margin_m(const Pose& pose) const;
  double slack_m(const Pose& pose) const;
  Slopes slopes(const Pose& pose, double here_m) const;
  void add(Part& part, PathGeometry& geometry, double mu);

  /// A place where the robot stands, in the program's frame, and the slack there.
  struct Stop {
    Point2 at_m{};
    double slack_m{};
  };

  const Program& program_;
  std::vector<Part> parts_{};
  std::vector<Stop> stops_{};
};

}  // namespace joulepath::joint
