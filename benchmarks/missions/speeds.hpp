#pragma once

#include "benchmarks/missions/case.hpp"

namespace joulepath::bench {

/// CPU seconds of ten legs between random places, on a prepared floor without known routes.
[[nodiscard]] double ten_legs_s(const Floor& floor, std::mt19937& random);

/// CPU seconds of one mission of two given curves, mean of many.
[[nodiscard]] double given_paths_s(const Robot& robot, std::mt19937& random);

}  // namespace joulepath::bench
