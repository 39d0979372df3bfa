#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// A run's mean power (W), as measured and as a model predicts it.
struct RunPower {
  std::size_t run{};  ///< index in the dataset
  double measured_W{}, predicted_W{};

  double gap_W() const { return std::abs(measured_W - predicted_W); }
};

/// The usable runs that fit and judge, under the names as fitted on the diagnosis runs; `more`: further runs of
/// the dataset.
[[nodiscard]] std::vector<RunPower> run_powers(const Examination& examination, const Validation& validation,
                                               const std::vector<std::size_t>& more = {});

/// Runs whose gap is `ratio` times that of every other run, and above the noise floor and kLeastApart of the mean
/// power: at most a tenth of the runs, or one. A model of the robot that suits the others does not hold for them.
[[nodiscard]] std::set<std::size_t> runs_apart(std::vector<RunPower> powers, double ratio,
                                               double noise_floor_percent);

}  // namespace joulepath
