#pragma once

#include "diagnosis/correction/judged_model.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace joulepath {

/// The judgment after the judging runs, and its fitted model.
struct Validation {
  Judgment judgment{};
  Refit fitted{};       ///< the names fitted on the diagnosis runs (calibration alone without names)
  JudgedModel model{};  ///< of the names, as the judging runs meet it
  /// The names, or the part of them, that may be written: it does not widen the judging runs' energy gap.
  std::optional<ModelState> corrected{};
};

/// Fits the names beside the unknown terms, drops those that a fit cannot tell from 0 or that lie outside
/// their range, and finds the part whose correction the judging runs bear out.
[[nodiscard]] Validation validate(const Examination& examination, const Judgment& by_race);

/// The gap on the judging runs, before and after, beside its floors.
[[nodiscard]] GapReport held_out_gap(const Examination& examination, const Validation& validation,
                                     std::size_t bootstrap);

}  // namespace joulepath
