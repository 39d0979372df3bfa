#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// What a user takes over; a note gives the reason if there is nothing.
struct Correction {
  std::optional<Robot> robot{};          ///< constants moved, physical effects added
  std::vector<EffectSetting> effects{};  ///< those that are added
  std::vector<EffectSetting> instruments{};
  std::vector<std::string> notes{};
  std::string refused{};  ///< why a robot that shrinks the gap is not written; empty: none was refused
};

/// The corrected robot, if the cause is unambiguous: the part of the names that does not widen the held-out
/// gap.
[[nodiscard]] Correction correction_of(const Examination& examination, const Validation& validation);

}  // namespace joulepath
