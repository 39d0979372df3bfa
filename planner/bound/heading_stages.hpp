#pragma once

#include <vector>

#include "planner/bound/rate_table.hpp"

namespace joulepath {

/// A part of the way with the rates (J/m) of turning along it.
struct HeadingStage {
  struct Node {
    double offset_m{};  ///< from the middle of the stage
    double weight_m{};  ///< of the trapezoidal rule, below a function that is concave between the nodes
    HeadingRates rates{};
  };
  double length_m{};
  int group{};      ///< stages of a group are alike
  bool optional{};  ///< a motion may leave out any part of it
  std::vector<Node> nodes{};

  double most_J() const { return nodes.front().rates.most_J; }

  /// A lower bound of the integral over the stage of H_sigma(per_rad_J - (sigma - middle) F(sigma)), for any
  /// F (J/(rad m)) between two values: H is concave in both arguments together.
  double cost_J(double per_rad_J, double least_slope, double most_slope) const;
};

/// The stages from the given heading on: those of a line whose peak is drawn out to `least_m`, with a further
/// part up to `most_m` that a motion may leave out. Backward they begin at the goal, where a turn counts with
/// the opposite sign.
[[nodiscard]] std::vector<HeadingStage> heading_stages(const RateTable& table, double least_m, double most_m,
                                                       bool backward);

}  // namespace joulepath
