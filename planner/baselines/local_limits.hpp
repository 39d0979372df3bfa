#pragma once

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath {

/// What holds a classic profile back along its path: speed caps, lateral acceleration, yaw rate and yaw
/// acceleration, |turn a + turn' b| <= limit. Of the latter a change of curvature may use a share by itself
/// (|turn' b| <= share of it); the rest is left to accelerate with. The request must outlive it.
class LocalLimits {
 public:
  explicit LocalLimits(const ProfileRequest& request);

  const nlp::Problem& problem() const { return problem_; }
  /// Whether curvature changes anywhere: else the share makes no difference.
  bool curves() const;
  /// Shares worth trying.
  std::vector<double> shares() const;

  /// The limits of one share on a grid, that of problem() to begin with.
  struct Grid {
    std::vector<double> s{};
    std::vector<double> cap{};           ///< of the rate's square, per node
    std::vector<std::size_t> segment{};  ///< of problem(), per segment of this grid
    /// A node at `place`, unless one is there.
    void insert(double place);
  };
  Grid grid(double curve_share) const;

  /// Largest squares of the rate below `ceiling` (per node) and the caps that accelerate and brake by no
  /// more than given, from the start to the end speed of the request.
  std::vector<double> below(const Grid& grid, std::vector<double> ceiling, double acceleration,
                            double deceleration) const;
  /// Whether such squares keep start and end speed, and never stop in between.
  bool passes(const std::vector<double>& b) const;

 private:
  /// Largest acceleration (deceleration) in a segment of problem() beside a node with the square b.
  double steepest(std::size_t segment, double ds, double b, bool accelerates) const;

  const ProfileRequest* request_{};
  nlp::Problem problem_{};
};

}  // namespace joulepath
