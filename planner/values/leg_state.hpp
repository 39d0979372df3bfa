#pragma once

#include <array>

#include "model/plant.hpp"

namespace joulepath {

/// What changes over a mission and is constant over one of its legs: the battery's open-circuit voltage and
/// the resistance of the windings. The defaults change nothing.
struct LegState {
  double open_circuit_voltage_V{kNoLimit};    ///< finite where the battery has a curve: the least on the leg
  Sided<double> resistance_factor{1.0, 1.0};  ///< of the copper, where the motors state `thermal`
  double price_of_heat{};  ///< what a joule of copper loss costs the planner beside itself, J/J
  Sided<double> planned_current_A{kNoLimit, kNoLimit};  ///< at most, where windings would become too hot

  bool operator==(const LegState&) const = default;
};

/// Whether a robot states what a LegState follows.
[[nodiscard]] bool drifts(const Robot& robot);

/// The robot, or the plant, as it is on a leg.
[[nodiscard]] Robot robot_in(Robot robot, const LegState& state);
[[nodiscard]] Plant plant_in(Plant plant, const LegState& state);

/// The plant's constants that differ between the legs of a mission, between trials of a verdict, or by a
/// margin of confidence: what of a plant is part of a cached question.
[[nodiscard]] std::array<double, 10> drifting_constants(const Plant& plant);

/// The plant with which a leg is planned, with its price of heat and its planned currents.
[[nodiscard]] Plant priced_plant_in(Plant plant, const LegState& state);

}  // namespace joulepath
