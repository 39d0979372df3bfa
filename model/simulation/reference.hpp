#pragma once

#include <vector>

#include "model/kinematics.hpp"
#include "model/motions.hpp"

namespace joulepath {

/// A trajectory to be driven: speeds linear between the samples, accelerations their slopes.
class Reference {
 public:
  /// Takes linear and angular speed, or the wheel speeds. Throws ConfigError without either.
  Reference(const Geometry& geometry, const Trajectory& trajectory);

  double start_s() const { return time_s_.front(); }
  double end_s() const { return time_s_.back(); }
  bool ends_at_rest() const;

  [[nodiscard]] BodyMotion<double> motion(double time_s);
  [[nodiscard]] double payload_kg(double time_s);
  /// Planned pose, by integrating the speeds from `start`; at samples.
  [[nodiscard]] Pose pose(double time_s);

  void start_at(const Pose& pose);

 private:
  std::size_t interval(double time_s);

  std::vector<double> time_s_{};
  std::vector<double> speed_m_s_{};
  std::vector<double> yaw_rate_rad_s_{};
  std::vector<double> payload_kg_{};
  std::vector<Pose> pose_{};
  std::size_t last_{};
};

}  // namespace joulepath
