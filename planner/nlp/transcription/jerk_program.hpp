#pragma once

#include <vector>

#include "planner/nlp/transcription/segment_program.hpp"
#include "planner/values/profile.hpp"

// Method: [HargravesParis1987]
namespace joulepath::nlp {

/// A motion with constant jerk between nodes: rate and acceleration at the nodes [N], times between [N - 1].
struct JerkMotion {
  std::vector<double> u{};
  std::vector<double> a{};
  std::vector<double> dt{};

  double duration_s() const;
};

struct JerkSolution {
  bool converged{};
  JerkMotion motion{};
  double objective{};
  double price_W{};
  int iterations{};
  std::string message{};
};

/// A Problem under a jerk limit. Acceleration is a state, linear in time between nodes, so that the limit
/// holds everywhere and not on average; it begins and ends at zero.
///
///   unknowns  u, a at the inner nodes, dt of each segment
///   rows      those of the Problem, and per segment
///             u1 = u0 + dt (a0 + a1)/2,   ds = dt (u0 + u1)/2 - dt^2 (a1 - a0)/12     (exact)
///             |a1 - a0| <= jerk dt
///             u0 + dt a0/2 <= mean of the caps at both ends: the rate's middle Bezier point, so that the
///             rate stays below them between the nodes, too
///   bounds    caps on u; linear acceleration on a
///
/// Recovery is counted at each quadrature point. Counted by segment, accelerations that alternate from node
/// to node would seem to return energy within a segment that a motor has used.
///
/// Not convex (products of dt), and three quantities at a node are coupled: Ipopt solves it.
class JerkProgram {
 public:
  static constexpr std::size_t kLocal = 5;  ///< u0, a0, u1, a1, dt
  static constexpr std::size_t kParts = kEnergyPoints;

  /// `guess` need not satisfy the rows; it sets the scales. Keeps a reference to the problem.
  JerkProgram(const Problem& problem, const std::vector<Tightening>& tightenings, JerkMotion guess);

  /// The same program with another rounding of kinks.
  JerkProgram(const JerkProgram& program, const Problem& rounded);

  const Problem& problem() const { return p_; }
  std::size_t unknown_count() const { return 2 * inner() + p_.segment_count(); }
  double start(std::size_t i) const;
  /// Squares of the rate at all nodes, of the guess.
  std::vector<double> squares() const;
  Bounds unknown_bounds(std::size_t i) const;
  std::size_t row_count(std::size_t k) const { return rows_[k].size() + kOwnRows; }
  Bounds row_bounds(std::size_t k, std::size_t i) const;
  /// The first of the two rows of the kinematics of a segment.
  std::size_t first_kinematic_row(std::size_t k) const { return rows_[k].size(); }
  Columns<kLocal> columns(std::size_t k) const;
  /// The segment of an unknown (of a node's: the one before it), and its index among that segment's unknowns.
  std::pair<std::size_t, std::size_t> place_of(std::size_t unknown) const {
    if (unknown < inner()) return {unknown, 2};
    if (unknown < 2 * inner()) return {unknown - inner(), 3};
    return {unknown - 2 * inner(), 4};
  }
  void evaluate(const double* x, std::size_t k, SegmentValues<kLocal>& values) const;

  /// All unknowns in SI units, the fixed ends included.
  JerkMotion motion(const std::vector<double>& x) const;

 private:
  static constexpr std::size_t kOwnRows = 5;  ///< the last of a segment: speed, distance, jerk up, down, cap

  std::size_t inner() const { return p_.unknown_count(); }
  std::array<double, kLocal> local(const double* x, std::size_t k) const;

  const Problem& p_;
  JerkMotion guess_{};
  std::vector<std::vector<std::size_t>> rows_{};  ///< of the problem, by segment, without acceleration
  std::vector<Bounds> acceleration_{};            ///< at the nodes
  std::vector<double> jerk_{};                    ///< largest, by segment
  double rate_scale_{}, acceleration_scale_{}, time_scale_{};
};

/// A start for the program: rate and acceleration of a profile, averaged over a window of time.
[[nodiscard]] JerkMotion averaged_motion(const Profile& profile, double window_s);

/// The executable profile of a motion on the nodes `s`.
[[nodiscard]] Profile profile_from_motion(const std::vector<double>& s, const JerkMotion& motion);

}  // namespace joulepath::nlp
