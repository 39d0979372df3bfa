#pragma once

#include <cstdint>
#include <vector>

namespace joulepath {

/// Squared Euclidean distance, in cells, from the center of each cell to the SQUARE of the nearest marked
/// cell (0 on marked cells); `kNoneMarked` where nothing is marked. Exact, O(cells): distances along columns,
/// then the lower envelope of parabolas along rows [FelzenszwalbHuttenlocher2012], with vertices at
/// the sides of squares. `marked[row * width + column] != 0`.
[[nodiscard]] std::vector<float> squared_distance_transform(const std::vector<std::uint8_t>& marked,
                                                            int width, int height);

inline constexpr float kNoneMarked = 1e12F;

}  // namespace joulepath
