#pragma once

#include <optional>

#include "planner/online/projection.hpp"
#include "planner/online/replanner.hpp"

// Design: docs/decisions/0321-a-follower-on-the-arc-length.md
namespace joulepath {

struct FollowerSettings {
  double period_s{0.05};      ///< between two commands
  double latency_s{0.05};     ///< from a pose to the command that it leads to
  double convergence_m{0.5};  ///< length of path over which a lateral error decays
  double off_path_m{0.3};     ///< a pose farther from the path is handed over
  double off_path_rad{0.8};
  double late_s{0.02};             ///< lateness that asks for a new profile
  double off_speed_m_s{0.15};      ///< difference from the profile that does, along a curve
  double off_yaw_rate_rad_s{0.6};  ///< the same in a turn in place
  ReplanBudget budget{};
};

/// What is known at an instant.
struct Measurement {
  double time_s{};  ///< since the piece's start was due
  Pose pose{};
  double speed_m_s{};  ///< signed
  double yaw_rate_rad_s{};
  double payload_kg{};                      ///< stated or estimated
  std::optional<double> speed_limit_m_s{};  ///< for the rest of the piece
  std::optional<double> stop_at_m{};        ///< the path is blocked from this coordinate on
};

enum class FollowState {
  driving,
  finished,  ///< at the end, at rest
  off_path,  ///< too far from the path: the command brakes, somebody else has to lead back
};

struct FollowCommand {
  FollowState state{FollowState::driving};
  double speed_m_s{};
  double yaw_rate_rad_s{};
  double acceleration_m_s2{};  ///< of the profile, from when the command takes effect
  double yaw_acceleration_rad_s2{};
  double s{};          ///< projection of the pose
  double lateral_m{};  ///< to the left of the path
  double heading_error_rad{};
  double late_s{};   ///< of the profile's end, against the deadline
  bool replanned{};  ///< in this call
};

/// Leads a robot along a planned piece: from its pose to the speed and yaw rate that it should have when the
/// command takes effect. The place on the path decides what is due, and a clock that runs along the profile:
/// a robot that falls behind is not chased, its rest is planned again. Allocates nothing after construction.
class Follower {
 public:
  /// `deadline_s`: of the piece's end, from the time at which its start was due; none for kNoLimit.
  Follower(const ProfileRequest& request, const Profile& plan, double deadline_s,
           const FollowerSettings& settings = {});
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  [[nodiscard]] FollowCommand command(const Measurement& measured);

  const Profile& profile() const { return *profile_; }

 private:
  void look(const Measurement& measured, FollowCommand& command);
  void advance_clock(const Measurement& measured);
  [[nodiscard]] bool has_to_replan(const Measurement& measured) const;
  void replan(const Measurement& measured, FollowCommand& command);
  void steer(const Measurement& measured, FollowCommand& command) const;
  void hand_over(const Measurement& measured, FollowCommand& command) const;
  [[nodiscard]] double rate_of(const Measurement& measured) const;
  [[nodiscard]] double off_rate() const;

  ProfileRequest request_;
  FollowerSettings settings_;
  Replanner replanner_;
  Profile plan_;
  const Profile* profile_{};
  double deadline_s_{};
  PathProjection projection_;
  double profile_time_s_{};  ///< on the profile
  std::optional<double> last_time_s_{};
  std::optional<double> last_limit_m_s_{}, last_stop_m_{};
  double last_payload_kg_{};
  double shift_s_{};  ///< expected end of the profile less the deadline
};

}  // namespace joulepath
