#pragma once

#include <optional>
#include <vector>

#include "planner/nlp/fast/fast_model.hpp"

namespace joulepath::nlp {

/// A quantity that has to stay positive, its multiplier, and their steps.
struct Pair {
  double s{}, y{};
  double ds{}, dy{};
  double corrected{};  ///< what s y should become: mu less the predictor's second order term
  double inverse{};    ///< 1/s, of this iteration
  double sigma{};      ///< y/s, of this iteration

  void prepare() {
    inverse = 1 / s;
    sigma = y * inverse;
  }
  void dual_step() { dy = (corrected - y * ds) * inverse - y; }
};

/// One side of an active row: c = sign (bound - g) >= 0, with a slack.
struct RowSide {
  std::size_t row{};
  std::size_t segment{};
  double sign{};
  double bound{};
  Pair pair{};
  double residual{};  ///< c - s
};

/// Energy recovered by one channel of one segment: z >= 0 and E + z >= 0, with a slack for the latter.
struct Recovery {
  Pair z{};
  Pair sum{};
  double residual{};       ///< E + z - s
  double inverse_sigma{};  ///< 1/(sum of both sigmas), of this iteration
};

/// Everything that an interior-point iteration moves. A cap that is infinite has an empty pair in `high`.
struct FastState {
  /// Room for problems of this size.
  void reserve(std::size_t nodes, std::size_t rows);

  std::vector<double> b{};  ///< squares of the rate at all nodes
  std::vector<Pair> low{};  ///< b >= 0, per inner node
  std::vector<Pair> high{};
  std::vector<RowSide> sides{};        ///< by segment
  std::vector<Recovery> recoveries{};  ///< [segment][channel]
  Pair time{};                         ///< slack of the duration's budget
  double lambda{};                     ///< multiplier of a duration that is fixed
  double time_residual{};              ///< of the duration's row
  DurationRow duration_row{};

  bool has_duration() const { return duration_row != DurationRow::none; }
  bool has_budget() const { return duration_row == DurationRow::at_most; }
  double multiplier_of_time() const { return !has_duration() ? 0.0 : has_budget() ? time.y : lambda; }

  template <class Function>
  void for_each_pair(Function&& use) {
    for (Pair& pair : low) use(pair);
    for (Pair& pair : high)
      if (pair.s > 0) use(pair);
    for (RowSide& side : sides) use(side.pair);
    for (Recovery& recovery : recoveries) {
      use(recovery.z);
      use(recovery.sum);
    }
    if (has_budget()) use(time);
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
