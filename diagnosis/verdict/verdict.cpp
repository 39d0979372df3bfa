#include "diagnosis/verdict/verdict.hpp"

#include <algorithm>

#include "diagnosis/thresholds.hpp"
#include "diagnosis/verdict/forms.hpp"
// Design: docs/decisions/0042-a-laws-form-is-uncertain.md
namespace joulepath {
namespace {

Judgment judge_leftover(const Examination& x, const Names& names) {
  Judgment judgment{.named = names.named, .leftover = find_leftover(x.id, x.best().columns)};
  const Leftover& leftover = judgment.leftover;
  if (x.runs.few) {
    judgment.verdict = Verdict::too_little_data;
    judgment.named.clear();
    judgment.notes.push_back("fewer than " + std::to_string(kLeastRunsToName) +
                             " runs: candidates only; add runs with two payloads, both directions and turns");
  } else if (judgment.named.empty()) {
    judgment.verdict = leftover.significant ? Verdict::unexplained : Verdict::no_gap;
  } else if (leftover.significant && leftover.share > kUnexplainedShare) {
    judgment.verdict = Verdict::unexplained;
    judgment.named.clear();
  } else {
    judgment.verdict = leftover.significant ? Verdict::partly_explained : Verdict::explained;
  }
  return judgment;
}

}  // namespace

Judgment judge(const Examination& x, const Names& names) {
  Judgment judgment = judge_forms(x, judge_leftover(x, names));
  const bool sure = std::ranges::any_of(judgment.named, [&](const ActiveEffect& effect) {
    return probability_of(names, effect) >= kSureEnough;
  });
  if (!judgment.named.empty() && !sure && judgment.verdict == Verdict::explained)
    judgment.verdict = Verdict::ambiguous;
  return judgment;
}

}  // namespace joulepath
