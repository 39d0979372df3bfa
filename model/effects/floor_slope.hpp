#pragma once

#include <array>
#include <cmath>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The floor is not level: driving uphill costs energy that driving downhill returns.
struct FloorSlope {
  double grade{};
  double uphill_direction_rad{};

  static constexpr EffectInfo info{
      .name = "floor_slope",
      .kind = "floor",
      .stage = Stage::body,
      .law = "force -m g grade cos(heading - uphill_direction) along the robot, and its moment where d != 0",
      .validity = "small grades",
      .source = "gravity on an inclined plane",
      .gazebo = "<gravity> or the pose of the ground plane",
      .mujoco = "gravity vector of the option element",
      .needs = {.samples = true}};
  static constexpr auto parameters() {
    return std::array{
        EffectParameter<FloorSlope>{"grade", "1", -0.3, 0.3, 0.005, "rise over run", &FloorSlope::grade},
        EffectParameter<FloorSlope>{"uphill_direction_rad", "rad", -7, 7, 1.0,
                                    "in floor coordinates, counter-clockwise from x",
                                    &FloorSlope::uphill_direction_rad, ParameterRole::direction}};
  }

  template <class Real>
  BodyLoad<Real> body_load(const BodyContext<Real>& body) const {
    const double angle_rad = uphill_direction_rad - body.site.pose.heading_rad;
    const double weight_N = kGravity_m_s2 * grade;
    return {Real(body.mass_kg * weight_N * std::cos(angle_rad)),
            Real(body.first_moment_kg_m * weight_N * std::sin(angle_rad))};
  }
};

}  // namespace joulepath
