#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The safe manoeuvre that best separates the remaining rivals. A library (standing, driving both ways, two
/// payloads, spins both ways, crawling, fast runs, hard stops, coasting) is searched for the manoeuvre with
/// the greatest predicted difference between the closest pair of rivals, each fitted to the present data.
/// Rivals are the causes and the effects that these runs cannot separate from them. Where there are none and
/// the verdict is open, rivals are the best explanations of the ranking.
[[nodiscard]] NextExperiment propose_run(const Identification& identification, const Robot& robot,
                                         const std::vector<Cause>& causes,
                                         const std::vector<RankedEffect>& ranking, Verdict verdict);

/// Noise-free signals of a prescribed motion for predictions, 0.1 s apart.
[[nodiscard]] RunSignals ideal_signals(const PrescribedMotion& motion, const Robot& robot, double payload_kg,
                                       double time_of_day_s);

}  // namespace joulepath
