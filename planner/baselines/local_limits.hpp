#pragma once

#include <array>
#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath {

/// Local limits of a classic profile along its path: speed caps, lateral acceleration, yaw rate and yaw
/// acceleration, |turn a + turn' b| <= limit. A change of curvature may use a share of the yaw acceleration
/// (|turn' b| <= share of it); the rest is left for the acceleration. The request must outlive it.
class LocalLimits {
 public:
  explicit LocalLimits(const ProfileRequest& request);

  const nlp::Problem& problem() const { return problem_; }
  /// Whether curvature changes anywhere; if not, the share makes no difference.
  bool curves() const;
  /// Shares to try.
  std::vector<double> shares() const;

  /// The limits for one share on a grid; the initial grid is that of problem().
  struct Grid {
    std::vector<double> s{};
    std::vector<double> cap{};           ///< of the rate's square, per node
    std::vector<std::size_t> segment{};  ///< of problem(), per segment of this grid
    /// Adds a node at `place` if there is none.
    void insert(double place);
  };
  Grid grid(double curve_share) const;

  /// Largest squares of the rate below `ceiling` (per node) and the caps, with at most these accelerations,
  /// from the start to the end speed of the request.
  std::vector<double> below(const Grid& grid, std::vector<double> ceiling, double acceleration,
                            double deceleration) const;
  /// Whether such squares keep the start and end speed, and never stop in between.
  bool passes(const std::vector<double>& b) const;

 private:
  /// Largest acceleration (deceleration) in a segment of problem() beside a node with the square b.
  double steepest(std::size_t segment, double ds, double b, bool accelerates) const;

  /// How the path turns at a limit point.
  struct Turn {
    double turn{}, turn_slope{};  ///< |turn| and |turn'|
    bool winds{};                 ///< both have the same sign
  };
  using SegmentTurns = std::array<Turn, nlp::kLimitPoints>;

  const ProfileRequest* request_{};
  nlp::Problem problem_{};
  std::vector<SegmentTurns> turns_{};  ///< per segment of problem(), close together in memory
};

}  // namespace joulepath
