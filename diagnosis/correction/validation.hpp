#pragma once

#include "diagnosis/correction/constant_errors.hpp"
#include "diagnosis/correction/judged_model.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace joulepath {

/// The judgment after the check on held-out runs, and its fitted model.
struct Validation {
  Judgment judgment{};
  Refit fitted{};       ///< the names fitted on the diagnosis runs (calibration alone without names)
  JudgedModel model{};  ///< of the names, for the held-out runs
  std::vector<SmallEffect> listed{};  ///< below the materiality floor, that were named before the fit
  /// The names, or the part of them, that may be written: it shrinks the held-out gap.
  std::optional<ModelState> corrected{};
  ConstantErrors errors{};  ///< of the constants of `corrected`; none where they are the file's
  std::string refused{};    ///< why the program would not read a correction; empty: it reads all
};

/// Fits the names beside the unknown terms, drops those that the fit cannot tell from 0 or that lie outside
/// their range, and finds the part whose correction shrinks the held-out gap.
[[nodiscard]] Validation validate(const Examination& examination, const Judgment& by_race);

/// Gap that the calibrated and corrected model leaves on the runs it was fitted to, but at most what the
/// scatter between runs allows: the error of a wrong model must not count as noise.
[[nodiscard]] double noise_floor_percent(const Examination& examination, const Refit& fitted,
                                         EnergyAt at = EnergyAt::motors_first);

/// The gap on held-out runs, before and after, with its noise floors.
[[nodiscard]] GapReport held_out_gap(const Examination& examination, const Validation& validation,
                                     std::size_t bootstrap);

}  // namespace joulepath
