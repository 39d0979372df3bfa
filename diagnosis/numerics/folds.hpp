#pragma once

#include <algorithm>
#include <vector>

#include "diagnosis/numerics/indices.hpp"

namespace joulepath {

/// The fold of each item, assigned in the order of the keys: every fold gets a share of each kind of item,
/// independent of the order of the items.
template <class Key>
std::vector<std::size_t> dealt_folds(const std::vector<Key>& keys, std::size_t folds) {
  std::vector<std::size_t> order = every(keys.size());
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  std::vector<std::size_t> fold_of(keys.size());
  for (std::size_t k = 0; k < order.size(); ++k) fold_of[order[k]] = k % folds;
  return fold_of;
}

}  // namespace joulepath
