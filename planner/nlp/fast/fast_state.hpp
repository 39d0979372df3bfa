#pragma once

#include <optional>
#include <vector>

#include "planner/nlp/fast/fast_model.hpp"
#include "planner/nlp/fast/interior_point.hpp"

namespace joulepath::nlp {

/// Everything that an interior-point iteration moves. A cap that is infinite has an empty pair in `high`.
struct FastState : SegmentPairs {
  /// Room for problems of this size.
  void reserve(std::size_t nodes, std::size_t rows);

  std::vector<double> b{};  ///< squares of the rate at all nodes
  std::vector<Pair> low{};  ///< b >= 0, per inner node
  std::vector<Pair> high{};

  template <class Function>
  void for_each_pair(Function&& use) {
    for (Pair& pair : low) use(pair);
    for (Pair& pair : high)
      if (pair.s > 0) use(pair);
    for_each_segment_pair(use);
  }
};

/// Where a solve starts: squares of the rate at all nodes, and how far from the optimum they are.
struct FastStart {
  const std::vector<double>& b;
  double gap{};   ///< complementarity of every pair, as a share of a segment's part of the objective
  double room{};  ///< least share of a cap that is left below it
  std::optional<double> price_W{};  ///< multiplier of the duration's budget, where it is known
};

/// Sets a strictly positive state near a start; evaluates the model there.
void set_starting_state(FastModel& model, const FastStart& start, FastState& state);

}  // namespace joulepath::nlp
