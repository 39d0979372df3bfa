#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"

namespace joulepath {

/// One explanation of the present runs that a further run shall be compared with.
struct Rival {
  std::string label{};  ///< of the effect that tells it from the other rivals
  ModelState state{};   ///< fitted to the present runs, its calibration, too
  Equations present{};  ///< of the present runs about the state
  double loss{};        ///< that its best fit leaves
};

/// For each label the best explanation with it and without the other labels, fitted to the present runs;
/// labels without one are left out.
[[nodiscard]] std::vector<Rival> fitted_rivals(const Identification& identification, const Robot& robot,
                                               const std::vector<std::string>& labels);

/// What a run would show if a rival were true, in the channels that the present runs have.
[[nodiscard]] RunSignals expected_signals(const Identification& identification, const Robot& robot,
                                          RunSignals motion, const Rival& truth);

/// Expected 2 ln LR of a further run for the true rival against another one. The other one's amplitudes,
/// forms and calibration are fitted anew to present and further runs, friction and resistance differ from run
/// to run:
///   D = min over p of [(p - p_present)' C^-1 (p - p_present) + |true - other(p)|^2]
[[nodiscard]] double expected_ratio(const Identification& identification, const Robot& robot,
                                    const RunSignals& shown_by_truth, const Rival& other);

}  // namespace joulepath
