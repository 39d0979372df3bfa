#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// Input of every step after the identification; the steps do not change it.
struct Examination {
  const Dataset& dataset;
  const RunsByUse& runs;
  const Identification& id;
  RobotRefusal refusal{};

  const Explanation& best() const { return id.explanations.front(); }
  ModelPoint nominal() const { return {.robot = dataset.robot}; }
  ModelPoint point_of(const ModelState& state) const {
    return model_point(dataset.robot, id.nuisances, state);
  }
};

}  // namespace joulepath
