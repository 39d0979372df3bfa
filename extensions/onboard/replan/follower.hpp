#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "extensions/onboard/replan/command_shaper.hpp"
#include "extensions/onboard/replan/loaded_limits.hpp"
#include "extensions/onboard/replan/projection.hpp"
#include "extensions/onboard/replan/replanner.hpp"

// Design: docs/decisions/0402-on-the-robot.md
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
  double acceleration_m_s2{};  ///< from when the command takes effect, for a period
  double yaw_acceleration_rad_s2{};
  double s{};          ///< projection of the pose
  double lateral_m{};  ///< to the left of the path
  double heading_error_rad{};
  double late_s{};                ///< of the profile's end, against the deadline
  bool replanned{};               ///< in this call
  std::string_view stopped_by{};  ///< the limit without which the robot would drive on; empty while it does
};

/// Leads a robot along a planned piece: from its pose to the speed and yaw rate that it should have when the
/// command takes effect. The place on the path decides what is due, and a clock that runs along the profile:
/// a robot that falls behind is not chased, its rest is planned again. Commands continue each other within
/// the limits, the jerk's too; where a correction of the course finds no room in them, the robot slows down.
/// Allocates nothing after construction.
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
  void look(const Measurement& measured, double elapsed_s, FollowCommand& command);
  void advance_clock(const Measurement& measured, double elapsed_s, double s);
  [[nodiscard]] bool has_to_replan(const Measurement& measured) const;
  void replan(const Measurement& measured, FollowCommand& command);
  void steer(const Measurement& measured, FollowCommand& command);
  void send(const Measurement& measured, const Limits& limits, FollowCommand& command);
  [[nodiscard]] bool ends(const FollowCommand& command) const;
  [[nodiscard]] std::span<const double> wanted_rates(const Measurement& measured,
                                                     const FollowCommand& command, double spacing_s);
  [[nodiscard]] double yaw_per_meter(const FollowCommand& command) const;
  void hand_over(const Measurement& measured, FollowCommand& command);
  [[nodiscard]] Limits limits_for(const Measurement& measured) const;
  [[nodiscard]] double lost_to_jerk(const Measurement& measured, double rate) const;
  [[nodiscard]] double rate_of(const Measurement& measured) const;
  [[nodiscard]] double off_rate() const;
  [[nodiscard]] bool is_off(const Measurement& measured, double due_rate) const;
  [[nodiscard]] double ahead_s() const;

  ProfileRequest request_;
  FollowerSettings settings_;
  LoadedLimits limits_;
  Replanner replanner_;
  Profile plan_;
  const Profile* profile_{};
  double deadline_s_{};
  PathProjection projection_;
  double place_{};      ///< of the last pose
  double pose_rate_{};  ///< of the path coordinate, from the last two poses
  CommandShaper shaper_;
  std::array<double, CommandShaper::kLook> wanted_{};
  double profile_time_s_{};  ///< on the profile; before the first command takes effect, negative
  std::optional<double> last_time_s_{};
  std::optional<double> last_limit_m_s_{}, last_stop_m_{};
  double last_payload_kg_{};
  bool handed_over_{};
  double shift_s_{};     ///< expected end of the profile less the deadline
  double accepted_s_{};  ///< lateness that the last new profile could not avoid
  std::string_view stopped_by_{};
};

}  // namespace joulepath
