#pragma once

#include "diagnosis/verdict/verdict.hpp"

namespace joulepath {

/// The judgment after the held-out runs, and its fitted model.
struct Validation {
  Judgment judgment{};
  double energy_left_share{};  ///< of the held-out gap, where the names explain a part only
  Refit fitted{};              ///< the names fitted on the diagnosis runs (calibration alone without names)
  ModelState state{};          ///< of the fit, its calibration dropped where that brings the energy no nearer
};

/// Fits the names on the diagnosis runs, judges on the held-out ones, and takes back what does not hold
/// there.
[[nodiscard]] Validation validate(const Examination& examination, const Judgment& by_diagnosis_runs);

/// The gap on the held-out runs, before and after, beside its floors.
[[nodiscard]] GapReport held_out_gap(const Examination& examination, const Validation& validation,
                                     std::size_t bootstrap);

}  // namespace joulepath
