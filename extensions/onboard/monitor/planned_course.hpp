#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/robot.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// A leg as planned, with its stop.
struct PlannedLeg {
  double energy_J{};
  double sigma_J{};  ///< zero: the plan states none
};

/// What a plan says along its wheels' travel.
struct PlannedCourse {
  std::vector<double> travel_m{};  ///< mean of both wheels' unsigned travel, never falling
  std::vector<double> time_s{};
  std::vector<double> energy_J{};
  std::vector<double> payload_kg{};
  std::vector<std::size_t> leg{};
  std::vector<PlannedLeg> legs{};
  std::optional<double> sigma_J{};           ///< of the whole energy; absent: the plan states none
  std::optional<double> battery_fraction{};  ///< at the start
};

/// Unsigned travel of a wheel speed (m/s at the rim), the measure of progress of plan and log.
[[nodiscard]] double rim_speed_m_s(const Geometry& geometry, const Sided<double>& wheel_speed_rad_s);

/// Travel, time, energy, payload and leg of a plan's trajectory (trajectory.csv).
[[nodiscard]] PlannedCourse planned_course(const Geometry& geometry, const Trajectory& trajectory);

/// Where on its plan a robot is: by the travel of its wheels, which every log has. At a stop the odometry's
/// error is taken out by the stop of the plan that is near.
class CourseProgress {
 public:
  explicit CourseProgress(const PlannedCourse& course);

  /// Moves on by a time step with a speed at the rim.
  void advance(double step_s, double rim_speed_m_s);

  [[nodiscard]] double energy_J() const { return at(course_->energy_J); }
  [[nodiscard]] double leg_begin_J(std::size_t leg) const;  ///< planned up to there
  [[nodiscard]] double payload_kg() const { return course_->payload_kg[index_]; }
  [[nodiscard]] std::size_t leg() const { return course_->leg[index_]; }
  [[nodiscard]] double time_s() const { return at(course_->time_s); }
  /// At the plan's end, as far as the odometry can tell.
  [[nodiscard]] bool has_arrived() const;

 private:
  [[nodiscard]] double at(const std::vector<double>& values) const;
  [[nodiscard]] bool waits() const;            ///< the plan stands from the present sample to the next
  [[nodiscard]] double stop_within_m() const;  ///< error of the odometry since the last stop, at most
  void snap_to_stop();
  void wait_with_the_plan(double step_s);

  const PlannedCourse* course_;
  std::vector<std::size_t> stops_{};  ///< first sample of each
  std::size_t index_{};
  double travel_m_{}, since_stop_m_{}, since_rest_m_{}, standing_s_{}, rest_clock_s_{};
  bool made_stop_{};  ///< the robot has stood at the plan's present stop
};

}  // namespace joulepath
