#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/whitening.hpp"
#include "diagnosis/numerics/normal_equations.hpp"
#include "diagnosis/prediction/dictionary.hpp"
#include "diagnosis/prediction/model_state.hpp"

namespace joulepath {

/// Meaning of a column of the linear problem.
struct Column {
  enum class Kind { nuisance, amplitude, shape, form, dictionary };
  Kind kind{};
  int owner{};  ///< index of nuisance, candidate or dictionary entry
  int part{};   ///< which amplitude, shape parameter or form of the owner
  double prior_sd{};
  double current{};  ///< value at the state: parameters of the problem are absolute; shapes are changes
};

/// A cause that no law of the catalog stands for: a smooth curve of something that was measured, in one
/// channel, or in all that the reading of a current takes part in (0505).
struct UnknownTerm {
  std::string label{};         ///< what it depends on and where it acts: "wheel speed (current)"
  std::vector<int> columns{};  ///< of the equations
};

/// The linear problem about a state of the model, for all runs, with everything that may be asked of it.
struct Equations {
  std::vector<Column> columns{};
  std::vector<Candidate> candidates{};  ///< those of the state first, in its order
  std::vector<DictionaryEntry> dictionary{};
  std::vector<UnknownTerm> unknowns{};  ///< the dictionary by family and channel
  std::vector<RunEquations> runs{};
  NoiseModel noise{};
  /// Of friction left, right, resistance left, right, gyro, standby, open-circuit voltage and its change by
  /// charge; of the payload where a run states none.
  Eigen::VectorXd run_variance{};
  Eigen::VectorXd prior_sd{};

  std::vector<int> columns_of(Column::Kind kind) const;
  /// Amplitudes, and with shapes also what may vary about them: shape parameters and forms.
  std::vector<int> columns_of_candidate(int candidate, bool with_shapes) const;
};

/// Laws whose strength may vary as their form allows: none, those of the state's effects, or those of every
/// candidate, as at its typical size.
enum class Forms { none, active, all };

struct EquationOptions {
  bool whole_catalog{true};  ///< false: the state's own effects alone
  bool dictionary{true};
  Forms forms{Forms::active};
  std::set<std::string> unknowns{};  ///< labels of the terms that enter without the whole dictionary
  const NoiseModel* noise{};         ///< reuse instead of estimating
  const Eigen::VectorXd* run_variance{};
  const NoiseModel* first_noise{};  ///< where the estimate starts; absent: white
  std::set<std::string> without{};  ///< effects removed from the catalog
};

/// Linearizes the model at a state and compresses every run. `extra` are candidates beyond the
/// catalog's, such as effects with a region of the floor.
[[nodiscard]] Equations build_equations(const std::vector<RunSignals>& signals, const Robot& robot,
                                        const std::vector<Nuisance>& nuisances, const ModelState& state,
                                        const std::vector<Candidate>& extra, const EquationOptions& options);

}  // namespace joulepath
