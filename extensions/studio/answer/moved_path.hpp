#pragma once

#include "planner/ways/leg_path.hpp"

namespace joulepath::studio {

/// A path with moved ends, for drafts while a stop is dragged: the similarity transform that maps the old
/// ends of its curves to the new ones (curvature stays continuous), with turns in place for the headings at
/// both ends. Obstacles are ignored. The same path where nothing moved; absent where its old or new ends
/// coincide.
[[nodiscard]] std::optional<Path> moved_path(const Path& path, const LegStart& start, const Station& goal);

}  // namespace joulepath::studio
