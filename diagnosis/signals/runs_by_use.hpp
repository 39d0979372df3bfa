#pragma once

#include <set>
#include <vector>

#include "diagnosis/signals/log_set.hpp"

namespace joulepath {

/// The runs of a dataset by what they are for.
struct RunsByUse {
  bool few{};           ///< too few with a usable log to name anything: each is in both sets
  LogSet diagnosis{};   ///< runs that choose and fit
  LogSet validation{};  ///< runs that judge; held out of the fit that predicts them, unless `few`
  std::vector<std::size_t>
      fold_of{};            ///< of each run that judges, where all runs choose, fit and judge in turn
  SignalOptions options{};  ///< how their logs are read
  std::vector<RunSignals> signals{};  ///< of all usable runs, electrical channels as logged
};

/// Runs marked `use: validation` judge and do nothing else. Without any, every run chooses and fits, and each
/// is judged by a fit of the other folds' runs; folds are dealt by manoeuvre, then by payload. They depend on
/// what is in the runs, not on their order.
/// Runs of `left_out` count as not usable.
[[nodiscard]] RunsByUse sort_runs(const Dataset& dataset, const std::set<std::size_t>& left_out = {});

/// 0 where runs do not take turns.
[[nodiscard]] std::size_t fold_count(const RunsByUse& runs);

/// Which of the diagnosis runs are fitted when the runs of a fold judge.
[[nodiscard]] std::vector<std::size_t> fitted_runs(const RunsByUse& runs, std::size_t fold);

}  // namespace joulepath
