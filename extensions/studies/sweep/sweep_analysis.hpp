#pragma once

#include <string>
#include <vector>

namespace joulepath {

/// One column of a study as levels: the entries of a list, or at most five parts of a range.
struct LevelColumn {
  std::string name{};
  std::vector<std::string> labels{};
  std::vector<std::size_t> level{};  ///< of each row: an index into labels
};

/// Labels in the order of their numbers (words: of their first appearance). More than `most` different
/// numbers are grouped into parts with equally many rows.
[[nodiscard]] LevelColumn levels_of(const std::string& name, const std::vector<std::string>& values,
                                    std::size_t most = 8, std::size_t parts = 5);

/// The columns of several parameters over the same rows. Where each value is nearly one row's own (a Latin
/// hypercube), any of them would explain all rows: numbers are grouped into so few parts that rows are left
/// over.
[[nodiscard]] std::vector<LevelColumn> level_columns(const std::vector<std::string>& names,
                                                     const std::vector<std::vector<std::string>>& values);

struct LevelMean {
  std::string label{};
  double mean{};
  std::size_t rows{};
};

/// The effect of one parameter on a result, averaged over the others.
struct MainEffect {
  std::string parameter{};
  std::vector<LevelMean> levels{};
  double
      share_of_variance{};  ///< of the rows' variance; of an additive model's if other designs are left out
};

/// The joint effect of two parameters beyond the sum of their own effects.
struct Interaction {
  std::string first{};
  std::string second{};
  double share_of_variance{};
};

struct SweepEffects {
  std::vector<MainEffect> main{};           ///< in the order of the parameters
  std::vector<Interaction> interactions{};  ///< the largest first
  double unexplained{};                     ///< share of variance left by main effects and interactions
};

/// Analysis of variance by least squares, which also holds if designs without a plan make the table
/// unbalanced: a parameter's share is the loss of fit of the additive model without it, an interaction's the
/// gain of the additive model with it. `values`: one per row, of rows with a plan.
[[nodiscard]] SweepEffects sweep_effects(const std::vector<LevelColumn>& columns,
                                         const std::vector<double>& values);

/// Rows that no other row beats in all objectives; each row holds values to be minimized.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<std::vector<double>>& rows);

}  // namespace joulepath
