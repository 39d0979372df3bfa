#pragma once

#include <map>
#include <string>

#include "model/power.hpp"

namespace joulepath {

/// The joules taken at the battery's terminals, by cause: `energy_by_cause_J` of a plan. They add up.
struct EnergyByCause {
  double copper_J{};
  double coulomb_friction_J{};
  double viscous_friction_J{};
  double kinetic_J{};
  double not_recovered_J{};
  double standby_J{};
  std::map<std::string, double> effects_J{};  ///< by name; effects of the same name share an entry

  /// Without standby: the energy of the motion alone.
  double motion_J() const;
  double total_J() const { return motion_J() + standby_J; }

  /// Adds `duration_s` seconds at these watts (one node of a quadrature).
  void add(const Plant& plant, const PowerByCause& watts, double duration_s);
  EnergyByCause& operator+=(const EnergyByCause& other);
};

/// Joules by the name of the cause, those of effects beside the others.
[[nodiscard]] std::map<std::string, double> named_causes_J(const EnergyByCause& energy);

}  // namespace joulepath
