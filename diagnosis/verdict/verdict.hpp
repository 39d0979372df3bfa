#pragma once

#include "diagnosis/verdict/names.hpp"

namespace joulepath {

/// Claims of the diagnosis.
struct Judgment {
  Verdict verdict{Verdict::too_little_data};
  std::vector<ActiveEffect> named{};
  std::vector<UnknownCause> unknowns{};
  std::string depends_on{};  ///< what no effect explains, in words; empty: nothing
  std::vector<std::string> notes{};
  Sizes sizes{};
};

/// The verdict that follows from what won the race.
[[nodiscard]] Judgment judge(const Examination& examination, const Names& names);

/// Whether an effect that is too small to count is sure enough to name it: it is listed, and is why something
/// is seen.
[[nodiscard]] bool has_small_effect(const Examination& x);

}  // namespace joulepath
