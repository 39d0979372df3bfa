#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"

namespace joulepath {

/// One way in which an effect of the catalog may act: its name, its side, its shape parameters fixed.
/// What is left are one or two amplitudes in which the model is nearly linear; zero means "absent".
struct Candidate {
  EffectSetting shape{};                 ///< parameters that are not amplitudes are set
  std::vector<std::string> amplitude{};  ///< names of the amplitudes: one, or two components of a vector
  std::vector<double> step{};            ///< for differencing, and the size worth noticing
  bool nonnegative{};                    ///< physics allows one sign only
  std::string label() const;             ///< name and side: the identity in a result
  const EffectDescription& effect() const;
};

/// The setting of a candidate with given amplitudes. Converts where a file's parameter is not the
/// amplitude itself: the reciprocal of an inverse strength, the components of a strength with a direction,
/// the change by a strength that replaces a value of the robot file.
EffectSetting setting_of(const Candidate& candidate, const std::vector<double>& amplitudes,
                         const Robot& robot);

/// Inverse of setting_of() for a setting of the same effect.
std::vector<double> amplitudes_of(const EffectSetting& setting, const Robot& robot);

/// The candidate of an effect with neither side nor shape parameters chosen.
Candidate bare_candidate(const EffectDescription& effect, const Robot& robot);

/// Every effect of the catalog with a grid over its shape parameters. Effects with a region of the floor are
/// left out: region_candidates() finds the region. Effects named in `without` are left out too.
std::vector<Candidate> catalog_candidates(const Robot& robot, const std::set<std::string>& without = {});

/// Names of an effect's shape parameters: those that no amplitude stands for.
std::vector<std::string> shape_parameters(const std::string& effect);

}  // namespace joulepath
