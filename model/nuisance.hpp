#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/robot.hpp"

namespace joulepath {

/// One constant of the robot file that a calibration may have missed, with its relative 1-sigma.
struct Nuisance {
  std::string key{};           ///< as in `uncertainty:`
  std::optional<Side> side{};  ///< where each side errs by itself
  double sigma{};              ///< relative
};

/// The entries of `uncertainty:`, one per constant; friction has an error on each side.
std::vector<Nuisance> nuisances_of(const Robot& robot);

/// The robot with that constant (1 + fraction) times its value. Payload is not a constant of the
/// robot: see payload_factor().
void apply_nuisance(const Nuisance& nuisance, double fraction, Robot& robot);

/// True for the payload's weighing error, which acts on the runs and not on the robot.
bool is_payload_nuisance(const Nuisance& nuisance);

/// Keys that `uncertainty:` may hold.
std::vector<std::string> nuisance_keys();

}  // namespace joulepath
