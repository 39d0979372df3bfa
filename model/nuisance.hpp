#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/robot.hpp"

namespace joulepath {

/// One constant of the robot file that may have a calibration error, with its relative 1-sigma.
struct Nuisance {
  std::string key{};           ///< as in `uncertainty:`
  std::optional<Side> side{};  ///< the side, for errors that are independent per side
  double sigma{};              ///< relative
};

/// The entries of `uncertainty:`, one per constant; friction has an error on each side.
std::vector<Nuisance> nuisances_of(const Robot& robot);

/// Multiplies that constant by (1 + fraction). Payload is not a constant of the robot: its error is
/// Plant::payload_factor.
void apply_nuisance(const Nuisance& nuisance, double fraction, Robot& robot);

/// True for the payload's weighing error, which acts on the runs and not on the robot.
bool is_payload_nuisance(const Nuisance& nuisance);

}  // namespace joulepath
