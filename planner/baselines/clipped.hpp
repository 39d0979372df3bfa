#pragma once

#include <functional>

#include "planner/baselines/baseline.hpp"

namespace joulepath {

/// A shape over the whole piece that takes a given time; nothing if no shape is so fast.
using ShapeOfDuration = std::function<std::optional<Profile>(double duration_s)>;

/// A classic shape held below the local limits of its path (LocalLimits). A faster shape compensates for the
/// time lost in the curves, so that the whole takes `duration_s`. The unclipped shape itself if it keeps
/// every limit.
[[nodiscard]] BaselineResult clipped_baseline(const ProfileRequest& request, const char* name,
                                              const ShapeOfDuration& shape, double duration_s,
                                              std::map<std::string, double> parameters);

}  // namespace joulepath
