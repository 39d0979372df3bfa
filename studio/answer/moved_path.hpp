#pragma once

#include "planner/ways/leg_path.hpp"

namespace joulepath::studio {

/// A path whose ends were moved, for a draft while a stop is dragged: the similarity that takes the old ends
/// of its curves to the new ones (turned, scaled, shifted: curvature stays continuous), with turns in place
/// for the headings at both ends. No obstacle is looked at. The same path where nothing moved; absent where
/// its ends coincide, or would.
[[nodiscard]] std::optional<Path> moved_path(const Path& path, const LegStart& start, const Station& goal);

}  // namespace joulepath::studio
