#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The safe manoeuvre that best separates the remaining rivals. Of a library, the manoeuvre with the greatest
/// expected likelihood ratio between the closest pair of rivals is chosen; then its speed, length, payload
/// and direction are changed one by one while that raises the ratio. Rivals are a cause and the effects that
/// these runs cannot separate from it, each fitted to the present runs. Where there is none and the verdict
/// is open, rivals are the best explanations of the ranking.
[[nodiscard]] NextExperiment propose_run(const Identification& identification, const Robot& robot,
                                         const std::vector<Cause>& causes,
                                         const std::vector<RankedEffect>& ranking, Verdict verdict);

}  // namespace joulepath
