#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// One diagnosis under way: what its steps hand on to each other.
struct Examination {
  const Dataset& dataset;
  DiagnoseOptions options{};
  Diagnosis report{};
  std::vector<std::size_t> usable{};  ///< runs with a log that can be worked on
  bool few{};                         ///< too few of them to name anything
  LogSet diagnosis{};                 ///< runs that choose and fit
  LogSet validation{};                ///< runs that judge only
  std::vector<RunSignals> all_signals{};
  Identification id{};
  ModelPoint nominal{};
  std::map<std::string, double> probabilities{};                ///< of effects by label
  std::map<std::string, std::vector<std::string>> stand_ins{};  ///< by label, what may be meant instead
  std::vector<ActiveEffect> named{};                            ///< what the diagnosis stands for, so far
  double energy_left_share{};  ///< of the held-out gap, where the names explain a part only

  ModelPoint point_of(const ModelState& state) const {
    return model_point(dataset.robot, id.nuisances, state);
  }
  /// Of a named effect, less what the names leave.
  double probability_of(const ActiveEffect& effect) const;
};

/// The named effects fitted on the diagnosis runs (calibration alone where there are none).
struct Correction {
  Refit fitted{};
  ModelState state{};
};

}  // namespace joulepath
