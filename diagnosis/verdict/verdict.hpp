#pragma once

#include "diagnosis/evidence/leftover.hpp"
#include "diagnosis/verdict/names.hpp"

namespace joulepath {

/// What the diagnosis claims, and what it leaves.
struct Judgment {
  Verdict verdict{Verdict::too_little_data};
  std::vector<ActiveEffect> named{};
  Leftover leftover{};
  std::vector<std::string> notes{};
};

/// Verdict and names by the diagnosis runs, before the held-out runs have a say.
[[nodiscard]] Judgment judge(const Examination& examination, const Names& names);

}  // namespace joulepath
