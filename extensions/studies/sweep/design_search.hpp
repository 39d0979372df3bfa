#pragma once

#include <functional>
#include <vector>

namespace joulepath {

/// The evaluation of a design.
struct DesignValue {
  bool planned{};      ///< a plan exists
  double objective{};  ///< to be minimized
  double excess{};     ///< the largest relative violation of a constraint; 0: none
};

struct DesignSearch {
  std::vector<double> best{};  ///< a fraction of each range
  DesignValue value{};
  std::size_t evaluations{};
};

/// Searches for the best design near `start` by Sbplx (NLopt), which needs no gradients; fractions stay in
/// [0, 1]. A design without a plan, or outside of a constraint, is worse than every design within. The search
/// is local: `start` should be the best design of a sweep. It ends when all fractions move by less than
/// `tolerance`.
[[nodiscard]] DesignSearch search_design(
    std::vector<double> start, std::size_t most_evaluations, double tolerance,
    const std::function<DesignValue(const std::vector<double>&)>& evaluate);

}  // namespace joulepath
