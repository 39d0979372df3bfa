#pragma once

#include <array>
#include <vector>

#include "model/effects/effect.hpp"

namespace joulepath {

/// Additional rolling resistance in a part of the floor: a carpet, a rough patch. The region is a rectangle,
/// or a list of cells.
struct FloorPatch {
  double coefficient{};
  double x_min_m{};
  double x_max_m{};
  double y_min_m{};
  double y_max_m{};
  std::vector<std::array<double, 4>> cells{};  ///< x_min, x_max, y_min, y_max each; replaces the rectangle

  static constexpr EffectInfo info{
      .name = "floor_patch",
      .kind = "resistance",
      .stage = Stage::wheel,
      .law = "torque = coefficient N r against the wheel while P0 is inside the region",
      .validity = "patches larger than the robot",
      .source = "Coulomb law of rolling friction",
      .gazebo = "a separate ground collision with its own <surface> friction",
      .mujoco = "a separate geom with its own rolling friction",
      .sign = Sign::nonnegative,
      .pliability = Pliability::anywhere,
      .needs = {.samples = true, .pose = true}};
  static constexpr auto parameters() {
    return std::array{
        EffectParameter<FloorPatch>{"coefficient", "1", -0.05, 0.5, 0.02,
                                    "rolling resistance coefficient inside the region",
                                    &FloorPatch::coefficient},
        EffectParameter<FloorPatch>{"x_min_m", "m", -1000000.0, 1000000.0, 1.0, "west edge, map frame",
                                    &FloorPatch::x_min_m, ParameterRole::edge},
        EffectParameter<FloorPatch>{"x_max_m", "m", -1000000.0, 1000000.0, 1.0, "east edge",
                                    &FloorPatch::x_max_m, ParameterRole::edge},
        EffectParameter<FloorPatch>{"y_min_m", "m", -1000000.0, 1000000.0, 1.0, "south edge",
                                    &FloorPatch::y_min_m, ParameterRole::edge},
        EffectParameter<FloorPatch>{"y_max_m", "m", -1000000.0, 1000000.0, 1.0, "north edge",
                                    &FloorPatch::y_max_m, ParameterRole::edge}};
  }

  bool contains(double x_m, double y_m) const {
    const auto inside = [&](double x0, double x1, double y0, double y1) {
      return x_m >= x0 && x_m <= x1 && y_m >= y0 && y_m <= y1;
    };
    for (const std::array<double, 4>& cell : cells)
      if (inside(cell[0], cell[1], cell[2], cell[3])) return true;
    return cells.empty() && inside(x_min_m, x_max_m, y_min_m, y_max_m);
  }

  bool branch(const Site& site) const { return contains(site.pose.x_m, site.pose.y_m); }

  template <class Real>
  Real shaft_torque_Nm(const WheelContext<Real>& wheel) const {
    if (!branch(wheel.site)) return Real(0.0);
    return Real(coefficient * wheel.normal_load_N * wheel.radius_m * wheel.direction);
  }
};

}  // namespace joulepath
