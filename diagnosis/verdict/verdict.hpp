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

}  // namespace joulepath
