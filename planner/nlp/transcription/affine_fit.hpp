#pragma once

#include <optional>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/interval/segment.hpp"
// Design: docs/decisions/0300-path-domain.md

namespace joulepath::nlp {

/// Determines the wheels' coefficients from the model at the places of a path. The plant must outlive it; one
/// thread uses it at a time.
class AffineFit {
 public:
  explicit AffineFit(const Plant& plant) : plant_(&plant) {}

  /// Returns false if the model is not affine in (a, b, u) there, because an effect's law is nonlinear;
  /// derivatives then include the effect.
  [[nodiscard]] bool at(const PathRates& rates, const Site& site, Sided<AffineWheel>& wheel);

 private:
  /// A quantity of a wheel per unit of each component of the body's motion.
  struct ByBody {
    double constant{}, speed{}, acceleration{}, yaw_rate{}, yaw_rate_squared{}, speed_by_yaw_rate{},
        yaw_acceleration{};
  };
  struct WheelByBody {
    ByBody current_A{}, voltage_V{}, force_N{};
  };
  void take_directions(const Site& site);

  const Plant* plant_;
  // Without effects the laws depend on nothing else of the place:
  std::optional<Sided<double>> wheel_direction_{};
  double payload_kg_{};
  Sided<WheelByBody> by_body_{};
};

}  // namespace joulepath::nlp
