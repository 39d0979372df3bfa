#pragma once

#include <vector>

#include "machine.hpp"

namespace blind {

/// Range of an effect's first parameter on a machine, and whether both signs are physical.
struct Range {
  const char* name;
  const char* parameter;
  double low;
  double high;
  bool both_signs;
};

/// A machine's own measures: the scale of an effect.
struct Scales {
  double torque_Nm, force_N, current_A, voltage_V, speed_rad_s, speed_m_s, mass_kg;
};

[[nodiscard]] Scales scales_of(const Machine& m);

/// Log-uniform ranges on this machine, from undetectable to large.
[[nodiscard]] std::vector<Range> catalog_ranges(const Machine& m);
[[nodiscard]] std::vector<Range> foreign_ranges(const Machine& m);

}  // namespace blind
