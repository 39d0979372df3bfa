#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "model/operating_point.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// A quantity that follows another one with a lag, and its rate, at each sample.
struct Lagged {
  Eigen::VectorXd value{}, rate{};
};

/// Solves lag_s y' + y = target from y = target at the first sample. Between two samples the target is the
/// parabola with these slopes that ends at the later one.
[[nodiscard]] Lagged lagged(const Eigen::VectorXd& target, const Eigen::VectorXd& slope,
                            const Eigen::VectorXd& lag_s, double period_s);

/// Creep of the contacts as a state: the body follows its wheels within mass / (2 stiffness), and its spin
/// within inertia / (2 stiffness half_track^2).
class ContactCreep {
 public:
  /// `contact_force_N`: at each sample those that the body would need if it followed its wheels at once.
  ContactCreep(const Plant& plant, const RunSignals& signals,
               const std::vector<Sided<double>>& contact_force_N);

  /// Of the body, at a sample in which the wheels move as `wheels` says.
  BodyMotion<double> body_motion(BodyMotion<double> wheels, Eigen::Index j) const;
  /// The wheels' own inertia follows the wheels, not the body.
  void spin_wheels(const Site& site, Eigen::Index j, Sided<WheelState<double>>& state) const;

  double along_m_s(Eigen::Index j) const { return along_.value[j]; }
  double turn_rad_s(Eigen::Index j) const { return turn_.value[j]; }

 private:
  const Plant& plant_;
  Lagged along_{}, turn_{};
};

}  // namespace joulepath
