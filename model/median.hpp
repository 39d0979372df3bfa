#pragma once

#include <algorithm>
#include <vector>

namespace joulepath {

/// The median of at least one value: the upper one of the two in the middle of an even number.
template <class T>
[[nodiscard]] T upper_median(std::vector<T> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace joulepath
