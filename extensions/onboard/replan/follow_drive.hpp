#pragma once

#include <optional>
#include <string>
#include <vector>

#include "extensions/onboard/replan/follower.hpp"
#include "extensions/onboard/replan/limit_use.hpp"
#include "model/simulation/controller.hpp"
#include "model/simulation/integrator.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Something that a plan does not know.
struct Disturbance {
  enum class Kind {
    push,         ///< `size` N along the heading for `for_s`
    slip,         ///< wheels turn in vain for `size` m; the robot drifts aside by a third of it
    late_start,   ///< `size` seconds late
    payload,      ///< `size` times the stated payload, known `for_s` after the start
    obstacle,     ///< the path is blocked `size` m ahead for `for_s`
    speed_limit,  ///< `size` m/s for `for_s`
  };
  Kind kind{Kind::push};
  double at_s{};  ///< in the plan's time
  double for_s{};
  double size{};
};

/// A piece that is followed, and when it is due.
struct FollowedPiece {
  const ProfileRequest* request{};
  const Profile* plan{};
  double start_s{};     ///< in the plan's time
  double deadline_s{};  ///< of its end
};

struct FollowRequest {
  Robot robot{};                         ///< as the drives' controllers believe it to be
  std::vector<EffectSetting> effects{};  ///< of the plant besides
  std::vector<FollowedPiece> pieces{};
  Pose start{};
  double end_s{};  ///< of the plan; the robot waits for it
  std::vector<Disturbance> disturbances{};
  FollowerSettings follower{};
  ControllerSettings controller{};
};

/// Where a drive stopped for good without having arrived.
struct FollowStop {
  double time_s{};      ///< on the clock of the executed log
  std::size_t piece{};  ///< counted from 0
  double s{};           ///< path coordinate of the piece
  Pose pose{};
};

struct FollowResult {
  Trajectory executed{};  ///< truth at 50 Hz; ends where the drive stopped without having arrived
  double energy_J{};      ///< at the battery's terminals, standby included, until `duration_s`
  double duration_s{};    ///< until the last piece's end is reached, the plan's end, or the stop
  double arrived_s{};     ///< at the end of the last piece
  double late_s{};        ///< of the latest arrival against its deadline
  double worst_lateral_m{};
  double end_error_m{};
  double end_error_rad{};
  std::size_t replans{};
  std::size_t finished{};          ///< pieces
  std::vector<LimitUse> limits{};  ///< the largest uses by the commands
  std::optional<FollowStop> stopped{};
  bool off_path{};           ///< handed over; nothing is driven afterwards
  std::string stopped_by{};  ///< limit that stopped the last command; empty after a hand-over
};

/// Drives planned pieces by the Follower on the simulated robot: commands take effect after the follower's
/// latency and go on with their accelerations for its period, wheel-speed loops follow them. The plan's time
/// begins when the first command takes effect.
[[nodiscard]] FollowResult follow(const FollowRequest& request);

}  // namespace joulepath
