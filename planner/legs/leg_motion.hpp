#pragma once

#include <optional>
#include <vector>

#include "model/sampled_motion.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The motion of a leg's prescription, from the robot's state at the end of the previous leg.
[[nodiscard]] SampledMotion prescribed_motion(const LegPlan& leg, const Plant& plant);

/// The motion of a planned leg, along its stretches or as prescribed. It keeps references to the leg and the
/// plant.
class LegMotion {
 public:
  LegMotion(const LegPlan& leg, const Plant& plant);

  const PathMotion& stretch(std::size_t k) const { return stretches_[k]; }

  const std::optional<SampledMotion>& prescribed() const { return prescribed_; }

  /// Joules (J) at the battery's terminals between two instants, counted from the departure; waits and dwell
  /// use standby power.
  [[nodiscard]] double energy_J(double from_s, double to_s) const;

  /// Calls visit(node, elapsed_s) for the nodes of the energy integral of the whole leg; waits and dwell have
  /// none.
  template <class Visit>
  void integrate(Visit&& visit) const {
    double begin_s = 0;
    const auto visit_node = [&](const EnergyNode& node) { visit(node, begin_s + node.time_s); };
    for (std::size_t k = 0; k < stretches_.size(); ++k) {
      const Profile& profile = leg_->stretches[k].profile;
      integrate_profile(stretches_[k], profile, 0.0, profile.duration_s(), visit_node);
      begin_s += profile.duration_s();
    }
    if (!prescribed_) return;
    begin_s -= prescribed_->start_s();
    prescribed_->integrate_between(prescribed_->start_s(), prescribed_->end_s(), visit_node);
  }

 private:
  const LegPlan* leg_{};
  double standby_W_{};
  std::vector<PathMotion> stretches_{};
  std::optional<SampledMotion> prescribed_{};
};

}  // namespace joulepath
