#pragma once

#include <vector>

namespace joulepath {

/// State of the robot on its piece at an instant.
struct ProfileState {
  double time_s{};
  double s{};
  double rate{};          ///< ds/dt
  double acceleration{};  ///< d2s/dt2; at a node that of the segment that begins there
};

/// An executable motion along a piece: segments of constant jerk (0 in most), exact at any time.
///   rate = rate_k + a_k tau + j_k tau^2/2,   s = s_k + rate_k tau + a_k tau^2/2 + j_k tau^3/6
struct Profile {
  std::vector<double> time_s{};        ///< nodes
  std::vector<double> s{};             ///< nodes
  std::vector<double> rate{};          ///< nodes
  std::vector<double> acceleration{};  ///< at the start of each segment
  std::vector<double> jerk{};          ///< per segment
  double wait_s{};                     ///< at rest at the end

  double duration_s() const { return (time_s.empty() ? 0.0 : time_s.back()) + wait_s; }
  [[nodiscard]] ProfileState at_time(double time_s) const;
  [[nodiscard]] ProfileState at_s(double s) const;
  /// The same motion with more nodes: at these path coordinates, and none of its segments longer than
  /// `longest` (in s).
  [[nodiscard]] Profile divided(const std::vector<double>& at, double longest) const;
};

/// The profile with constant acceleration between nodes: b_k = rate_k^2.
[[nodiscard]] Profile profile_from_squares(const std::vector<double>& s, const std::vector<double>& b);

}  // namespace joulepath
