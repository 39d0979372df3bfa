#pragma once

#include <algorithm>
#include <vector>

#include "model/quadrature.hpp"

namespace joulepath {

/// Body motion and place at an instant of a trajectory whose speeds are linear between its samples.
struct SampledState {
  BodyMotion<double> motion{};
  Pose pose{};
  double arc_length_m{};
  double curvature_per_m{};
};
[[nodiscard]] SampledState sampled_state(const Trajectory& trajectory, double time_s);

/// Pose at the last sample of a trajectory that has samples.
[[nodiscard]] Pose end_pose(const Trajectory& trajectory);

/// Start of a sampled motion, and values that its channels do not contain.
struct SampledStart {
  double time_of_day_s{};       ///< at the first sample
  double payload_kg{};          ///< where the trajectory has no payload
  double standing_rad_s{1e-6};  ///< a wheel slower than this stands
  EffectMemory memory{};        ///< of the effects
};

/// Clears the directions of dry friction of wheels slower than `standing_rad_s`; returns whether both wheels
/// stand.
[[nodiscard]] bool clear_standing(const Geometry& geometry, const BodyMotion<double>& motion,
                                  double standing_rad_s, Site& site);

/// A trajectory driven by a plant: body speeds linear between the samples, payload that of the sample before.
/// It keeps references to the plant and the trajectory, which must outlive it.
class SampledMotion {
 public:
  /// `trajectory` has linear and angular speed in every sample.
  SampledMotion(const Plant& plant, const Trajectory& trajectory, const SampledStart& start = {});

  const Plant& plant() const { return *plant_; }
  double start_s() const { return trajectory_->time_s.front(); }
  double end_s() const { return trajectory_->time_s.back(); }
  [[nodiscard]] MotionInstant at(double time_s) const;
  [[nodiscard]] EffectMemory memory(double time_s) const;

  /// The nodes of the energy integral between two times of the trajectory.
  template <class Visit>
  void integrate_between(double from_s, double to_s, Visit&& visit) const {
    const std::vector<double>& times_s = trajectory_->time_s;
    if (times_s.empty()) return;
    for (std::size_t k = interval(from_s); k + 1 < times_s.size() && times_s[k] < to_s; ++k) {
      const double begin_s = std::max(from_s, times_s[k]), end_s = std::min(to_s, times_s[k + 1]);
      if (end_s > begin_s)
        integrate(
            *plant_, [&](double time_s) { return at(time_s); }, begin_s, end_s, visit);
    }
  }

 private:
  [[nodiscard]] std::size_t interval(double time_s) const;
  void advance(double from_s, double to_s, EffectMemory& memory) const;

  const Plant* plant_{};
  const Trajectory* trajectory_{};
  SampledStart start_{};
  std::vector<EffectMemory> memory_{};  ///< at the samples; empty without such effects
};

/// Joules by cause between two times of the trajectory.
[[nodiscard]] EnergyByCause energy_between(const SampledMotion& motion, double from_s, double to_s);

}  // namespace joulepath
