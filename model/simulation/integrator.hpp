#pragma once

#include "model/simulation/drive.hpp"

namespace joulepath {

struct IntegratorOptions {
  double tolerance{1e-8};  ///< of a step, absolute and relative
  double max_step_s{0.01};
};

/// Integrates a Drive over time: Cash-Karp steps with error control (Boost.Odeint). Bisection locates the
/// events at which a sliding surface comes to rest or a holding one breaks away, so that no step crosses a
/// corner of the friction law.
class DriveIntegrator {
 public:
  DriveIntegrator(Drive drive, const DriveState& start, const IntegratorOptions& options);

  Drive& drive() { return drive_; }
  const Drive& drive() const { return drive_; }
  const DriveState& state() const { return state_; }
  double time_s() const { return time_s_; }
  const FrictionMode& mode() const { return mode_; }
  /// Whether both wheels hold.
  bool at_rest() const { return mode_[kLeftWheel] == 0 && mode_[kRightWheel] == 0; }
  [[nodiscard]] Drive::Instant instant() const { return drive_.evaluate(state_, time_s_, mode_); }

  void advance_to(double end_s);

  /// Moves the robot on the floor, without a motion of its wheels: ahead, and to its left.
  void displace(double ahead_m, double left_m);

  std::size_t steps() const { return steps_; }
  std::size_t events() const { return events_; }
  bool battery_gave_way() const { return battery_gave_way_; }

 private:
  bool turned(const DriveState& state, Surface surface) const;
  bool corner(const DriveState& state, double time_s) const;
  void break_away();
  void settle();
  double locate_corner(const DriveState& from, double step_s, DriveState& beyond) const;

  Drive drive_;
  DriveState state_;
  FrictionMode mode_{};
  IntegratorOptions options_;
  double time_s_{};
  double step_s_{};
  std::size_t steps_{};
  std::size_t events_{};
  bool battery_gave_way_{};
};

}  // namespace joulepath
