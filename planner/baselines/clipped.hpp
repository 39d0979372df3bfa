#pragma once

#include <functional>

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// A shape over the whole piece that takes a given time; nothing where there is none so fast.
using ShapeOfDuration = std::function<std::optional<Profile>(double duration_s)>;

/// A classic shape held below the local limits of its path (LocalLimits): the rate is that of the shape
/// where it can be, and what it loses in the curves it makes up for by a faster shape, such that the whole
/// takes `duration_s`. The unclipped shape itself where that keeps every limit.
[[nodiscard]] BaselineResult clipped_baseline(const ProfileRequest& request, const char* name,
                                              const ShapeOfDuration& shape, double duration_s,
                                              std::map<std::string, double> parameters);

}  // namespace joulepath
