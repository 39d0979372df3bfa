#pragma once

#include "model/plant.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A plan over time: uniform samples (50 Hz by default), dwell and waiting included, the last sample at the
/// end. It has the channels of a run log; energy_J is the energy from the battery's terminals since the
/// start.
[[nodiscard]] Trajectory plan_trajectory(const Plan& plan, const Plant& plant, double rate_Hz = 50.0);

/// The same at these ascending times (s) within the plan, exact at each; energy_J counts from the first.
[[nodiscard]] Trajectory plan_trajectory_at(const Plan& plan, const Plant& plant,
                                            const std::vector<double>& times_s);

/// A plan at the nodes of its profiles: there is a row wherever the acceleration (under a jerk limit: the
/// jerk) may change. Accelerations and jerk are valid from a row to the next one. Between two rows:
///   linear_speed = v + a t + j t^2/2,   linear_acceleration = a + j t.
struct PlanNodes {
  Trajectory rows{};
  std::vector<double> angular_acceleration_rad_s2{};
  std::vector<double> linear_jerk_m_s3{};
};
[[nodiscard]] PlanNodes plan_nodes(const Plan& plan, const Plant& plant);

}  // namespace joulepath
