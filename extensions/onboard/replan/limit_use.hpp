#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/motion.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// The largest part of a limit that a series of commands used.
struct LimitUse {
  std::string limit{};
  double fraction{};  ///< |value|/limit
  double at_s{};
};

/// Finds the largest use of each limit by commands as they are sent: accelerations are the differences of one
/// command to the next, jumps included; the jerk is the change of acceleration over a period. Currents,
/// voltages and forces are those of the nominal model.
class CommandAudit {
 public:
  explicit CommandAudit(const Plant& plant) : plant_(plant) {}

  /// A command that takes effect at `time_s`, with the payload that is known then.
  void add(double time_s, double speed_m_s, double yaw_rate_rad_s, double payload_kg);

  const std::vector<LimitUse>& uses() const { return uses_; }

 private:
  struct Command {
    double time_s{}, speed_m_s{}, yaw_rate_rad_s{}, payload_kg{};
    std::optional<double> gain_m_s2{};  ///< of speed, since the command before
  };
  void look(const BodyMotion<double>& motion, double gain_m_s2, double jerk_m_s3, double payload_kg,
            double time_s);

  Plant plant_;
  std::optional<Command> last_{};
  std::vector<LimitUse> uses_{};
};

}  // namespace joulepath
