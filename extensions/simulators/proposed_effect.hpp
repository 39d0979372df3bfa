#pragma once

#include <optional>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// A cause as a simulator's model is to have it: the size that the correction adds; without a correction its
/// own, where the causes shrink the gap of the runs that judge them. Nothing where that gap does not shrink
/// or the correction leaves the effect out, also where the robot file has it.
[[nodiscard]] std::optional<EffectSetting> proposed_effect(const Cause& cause, const Diagnosis& diagnosis);

}  // namespace joulepath
