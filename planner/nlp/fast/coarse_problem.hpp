#pragma once

#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath::nlp {

/// A Problem on a subset of another one's nodes, built from that one's segments without new evaluations of
/// path or model: accurate enough for a start, not for a plan.
struct CoarseProblem {
  Problem problem{};
  std::vector<std::size_t> node{};  ///< of the fine problem, per coarse node

  /// Values at the coarse nodes, from values at all fine nodes.
  [[nodiscard]] std::vector<double> restricted(const std::vector<double>& fine) const;
  /// Interpolates linearly in s between coarse nodes, as squares of the rate are linear at constant
  /// acceleration.
  [[nodiscard]] std::vector<double> prolonged(const std::vector<double>& coarse, const Problem& fine) const;
};

/// `merged`: how many segments become one (the last may be shorter).
[[nodiscard]] CoarseProblem coarsen(const Problem& fine, std::size_t merged);

}  // namespace joulepath::nlp
