#pragma once

#include "diagnosis/evidence/leftover.hpp"
#include "diagnosis/verdict/names.hpp"

namespace joulepath {

/// Claims of the diagnosis, and the leftover.
struct Judgment {
  Verdict verdict{Verdict::too_little_data};
  std::vector<ActiveEffect> named{};
  Leftover leftover{};
  std::vector<std::string> notes{};
};

/// Verdict and names by the diagnosis runs, before the validation on held-out runs.
[[nodiscard]] Judgment judge(const Examination& examination, const Names& names);

}  // namespace joulepath
