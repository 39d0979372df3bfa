#pragma once

#include <vector>

#include "diagnosis/checks/implausible.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// What is wrong with the clock of a run: stamps in another unit than seconds.
[[nodiscard]] std::vector<Implausible> implausible_clock(const Run& run);

/// By the columns' bounds, the clock, the wheels and the body's speed.
[[nodiscard]] std::vector<Implausible> implausible_channels(const Run& run, const Robot& robot);

}  // namespace joulepath
