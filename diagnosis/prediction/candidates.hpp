#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"

namespace joulepath {

/// One hypothesis about an effect of the catalog: its name, its side and fixed shape parameters. Its free
/// parameters are one or two amplitudes in which the model is nearly linear; zero means "absent".
struct Candidate {
  EffectSetting shape{};                 ///< all parameters except the amplitudes
  std::vector<std::string> amplitude{};  ///< names of the amplitudes: one, or two components of a vector
  std::vector<double> step{};            ///< step for finite differences, and the smallest size of interest
  bool nonnegative{};                    ///< physics allows one sign only
  std::string label() const;             ///< name and side: identifies the candidate in results
  const EffectDescription& effect() const;
};

/// The setting of a candidate with given amplitudes. Converts where the parameter in a file is not the
/// amplitude: the reciprocal of an inverse strength, the components of a strength with a direction, and the
/// change by a strength that replaces a value of the robot file.
EffectSetting setting_of(const Candidate& candidate, const std::vector<double>& amplitudes,
                         const Robot& robot);

/// Inverse of setting_of() for a setting of the same effect.
std::vector<double> amplitudes_of(const EffectSetting& setting, const Robot& robot);

/// How far amplitudes lie outside of what the catalog accepts for their effect (0: inside).
double outside_range(const Candidate& candidate, const std::vector<double>& amplitudes, const Robot& robot);

/// The candidate of an effect, without a side and without shape parameters.
Candidate bare_candidate(const EffectDescription& effect, const Robot& robot);

/// Every effect of the catalog with a grid over its shape parameters, except effects with a region of the
/// floor (region_candidates() finds the region) and effects named in `without`.
std::vector<Candidate> catalog_candidates(const Robot& robot, const std::set<std::string>& without = {});

/// Names of an effect's shape parameters: all parameters that are not amplitudes.
std::vector<std::string> shape_parameters(const std::string& effect);

}  // namespace joulepath
