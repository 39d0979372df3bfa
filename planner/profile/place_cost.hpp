#pragma once

#include "model/plant.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/interval/range.hpp"
#include "planner/nlp/transcription/affine_fit.hpp"
#include "planner/profile/wheel_power.hpp"
#include "planner/values/profile_request.hpp"

// Method: [Pontryagin1962]
namespace joulepath {

/// Data for all places of a path: the request, and the plant without its nonlinear parts.
struct CostModel {
  CostModel(const ProfileRequest& request, const PathMotion& motion, double time_W = 0.0);
  CostModel(const CostModel&) = delete;  // affine_fit refers to unbent
  CostModel& operator=(const CostModel&) = delete;

  const ProfileRequest& request;
  const PathMotion& motion;
  double time_W{};
  Plant unbent{};                     ///< without gear loss and driver drop
  mutable nlp::AffineFit affine_fit;  ///< of that plant; remembers the last wheel directions
  bool bent{};                        ///< the plant has one of them
  bool warms_up{};                    ///< winding resistance depends on the time
  double least_resistance{};          ///< time of the day (s) of the lowest winding resistance
};

/// The cost per second and the limits at one place of a path, for any rate u and acceleration a:
///   H(u, a) = sum max(P, eta P) + time_W,   time_W: standby, price and multiplier of the time.
class PlaceCost {
 public:
  PlaceCost(const CostModel& model, double s, double time_s);

  /// H of a planned state, at its own time of the day.
  double at(double u, double a) const;

  /// Smallest H(u, a) - q a over the accelerations that every limit allows at the rate u; infinite if there
  /// is none. At a fixed rate, powers are convex and piecewise quadratic in a, so the minimum is exact.
  /// Limits that are not convex in a, and those of current, voltage and power with nonlinear parts of the
  /// plant, are left out: this lowers the minimum.
  double least(double u, double q) const;

  /// Largest rate: by caps, and by the accelerations from both ends.
  double fastest() const { return fastest_; }

  /// Accelerations within the limits at a rate; empty (low above high) if there are none.
  nlp::Range accelerations(double u) const { return accelerations(u, wheels_at(u)); }

  /// Square of the largest rate at which the limits permit an acceleration.
  double largest_square() const;

 private:
  Sided<WheelPower> wheels_at(double u) const;
  nlp::Range accelerations(double u, const Sided<WheelPower>& wheels) const;
  void cut_by_ratings(nlp::Range& range, const Sided<WheelPower>& wheels) const;
  void cut_by_sag(nlp::Range& range, const Sided<WheelPower>& wheels, Side side, double open_V) const;

  const CostModel* model_{};
  PathRates rates_{};
  Site planned_{};  ///< at the planned time
  Site site_{};     ///< at the time of the lowest resistance
  bool affine_{};
  Sided<nlp::AffineWheel> wheel_{};
  double fastest_{};
};

}  // namespace joulepath
