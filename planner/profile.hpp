#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/energy.hpp"
#include "planner/infeasibility.hpp"
#include "planner/path_motion.hpp"

namespace joulepath {

enum class TimeMode {
  fixed_time,    ///< exactly duration_s
  time_budget,   ///< at most duration_s
  free_time,     ///< least energy, standby included
  time_price,    ///< least energy + price_W T, at most duration_s
  minimum_time,  ///< least time, then least energy is not looked at
};

struct TimeGoal {
  TimeMode mode{TimeMode::free_time};
  double duration_s{kNoLimit};
  double price_W{};  ///< time_price only; on top of standby
};

/// Speed cap (m/s) on an interval of arc length; of no effect on a turn in place.
struct SpeedCap {
  double from_m{};
  double to_m{};
  double speed_m_s{};
};

enum class SolverChoice { ipopt, fast };

/// A piece of path to be driven without a stop, and what is wanted of it. Rates are those of the path
/// coordinate: m/s along a curve, rad/s in a turn in place.
struct ProfileRequest {
  PathPiece piece;
  Plant plant{};
  Limits limits{};  ///< already resolved for the payload, see limits_for_payload()
  PayloadAlongPath payload{};
  double start_rate{};
  double end_rate{};
  std::vector<SpeedCap> speed_caps{};
  TimeGoal time{};
  std::size_t nodes{200};
  double accuracy{1e-4};  ///< relative: NLP energy against replay, and the gap that counts as optimal
  SolverChoice solver{SolverChoice::ipopt};
  /// For comparing paths: one grid, limits kept at its nodes alone, jerk left out, no certificate.
  bool draft{};
  double time_of_day_s{};  ///< at the start
  EffectMemory memory{};   ///< of the effects, at the start
};

/// Where the robot is on its piece at an instant.
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

/// Dense quadrature of power_by_cause() along a profile (Gauss-Legendre within each segment, split where
/// the power changes its sign).
[[nodiscard]] EnergyByCause energy_by_cause(const PathMotion& motion, const Profile& profile);

enum class SolveStatus { optimal, feasible, infeasible, failed };
[[nodiscard]] const char* solve_status_name(SolveStatus status);

struct SolveSummary {
  SolveStatus status{SolveStatus::failed};
  std::string solver{};       ///< ipopt | fast | forward_backward
  int iterations{};           ///< over all refinements
  std::size_t nodes{};        ///< of the last grid
  double price_of_time_W{};   ///< -dE/dT: multiplier of the time row (standby included), 0 where time is free
  double lower_bound_J{};     ///< of the energy (of E + price T with time_price, of T with minimum_time)
  double gap_percent{};       ///< (value - lower bound)/value, discretization estimate included
  bool local{};               ///< the problem is not convex here: the bound is the best known, not a proof
  std::string handed_over{};  ///< why the fast solver gave over to Ipopt; empty if it did not
  std::string message{};
};

struct ProfileResult {
  SolveSummary summary{};
  std::optional<Profile> profile{};
  std::optional<Infeasibility> infeasibility{};
};

/// Least-energy (or least-time) profile within every limit, between nodes too. Never throws for what a
/// request asks: verdicts are data.
[[nodiscard]] ProfileResult solve_profile(const ProfileRequest& request);

/// The motion that a request's profile is evaluated with; the request must outlive it.
[[nodiscard]] PathMotion path_motion(const ProfileRequest& request);

/// Limits with `limits: by_payload` applied: per key, linear between the rows that name it.
[[nodiscard]] Limits limits_for_payload(const Robot& robot, double payload_kg);

}  // namespace joulepath
