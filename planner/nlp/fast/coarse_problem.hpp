#pragma once

#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

/// A Problem on every few nodes of another, made from that one's own segments without asking the path or the
/// model again: good for a start, not for a plan.
struct CoarseProblem {
  Problem problem{};
  std::vector<std::size_t> node{};  ///< of the fine problem, per coarse node

  /// Values at the fine problem's nodes that are on these; all nodes.
  [[nodiscard]] std::vector<double> restricted(const std::vector<double>& fine) const;
  /// Straight in s between coarse nodes, as squares of the rate are at constant acceleration.
  [[nodiscard]] std::vector<double> prolonged(const std::vector<double>& coarse, const Problem& fine) const;
};

/// `merged`: how many segments become one (the last may be shorter).
[[nodiscard]] CoarseProblem coarsen(const Problem& fine, std::size_t merged);

}  // namespace joulepath::nlp
