#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/evidence/equations.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {

/// Change of the results of a user that an effect causes, independent of statistics.
struct Impact {
  double motor_power{};    ///< sum |change| / sum |power|, over wheels and samples
  double battery_power{};  ///< the same at the battery's terminals
  double battery_voltage_V{};
  double heading_rad{};    ///< greatest change of a run's final heading
  double position{};       ///< greatest change of a run's final position / distance travelled
  double delay_samples{};  ///< delay of the electrical channels in samples of the log
};

/// Smaller changes are not reported as effects: about 1 % of the energy, or a comparable change of the
/// motion.
struct MaterialityFloor {
  double motor_power{kMaterialEnergy};
  double battery_power{kMaterialEnergy};
  double battery_voltage_V{kMaterialVoltage_V};
  double heading_rad{kMaterialHeading_rad};
  double position{kMaterialPosition};
  double delay_samples{kMaterialDelay_samples};
};

[[nodiscard]] Impact impact_between(const std::vector<RunSignals>& signals, const ModelPoint& with_effect,
                                    const ModelPoint& without_effect);

/// The same of an unknown term: entries of the dictionary with their strengths.
[[nodiscard]] Impact impact_of_term(const std::vector<RunSignals>& signals, const ModelPoint& point,
                                    const std::vector<int>& entries, const Eigen::VectorXd& strength);

/// Greatest ratio of an impact to the floor: 1 = just material.
[[nodiscard]] double materiality(const Impact& impact, const MaterialityFloor& floor = {});

/// Amplitude at which each candidate of the equations becomes material. `known` caches earlier results.
[[nodiscard]] std::vector<double> least_amplitudes(const std::vector<RunSignals>& signals, const Robot& robot,
                                                   const std::vector<Nuisance>& nuisances,
                                                   const ModelState& state,
                                                   const std::vector<Candidate>& candidates,
                                                   std::map<std::string, double>& known);

}  // namespace joulepath
