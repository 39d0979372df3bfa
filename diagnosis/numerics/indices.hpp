#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace joulepath {

/// 0, 1, ... count - 1.
inline std::vector<std::size_t> every(std::size_t count) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

}  // namespace joulepath
