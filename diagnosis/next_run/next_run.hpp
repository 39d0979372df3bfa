#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The safe manoeuvre that best separates what is still ambiguous: among a library (standing, driving both
/// ways, two payloads, spins both ways, crawling, fast runs, hard stops, coasting), the one whose
/// prediction differs most between the closest pair of rivals, each fitted to the data at hand.
/// Rivals are the causes and the effects that these runs cannot separate from them. Without any, and with an
/// open verdict, they are the best of the ranking.
[[nodiscard]] NextExperiment propose_run(const Identification& identification, const Robot& robot,
                                         const std::vector<Cause>& causes,
                                         const std::vector<RankedEffect>& ranking, Verdict verdict);

/// Ideal signals of a prescribed motion, for predictions: 0.1 s apart, no noise.
[[nodiscard]] RunSignals ideal_signals(const PrescribedMotion& motion, const Robot& robot, double payload_kg,
                                       double time_of_day_s);

}  // namespace joulepath
