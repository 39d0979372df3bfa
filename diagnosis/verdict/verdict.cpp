#include "diagnosis/verdict/verdict.hpp"

#include "diagnosis/evidence/leftover.hpp"
#include "diagnosis/signals/split.hpp"
#include "diagnosis/verdict/forms.hpp"

namespace joulepath {
namespace {

constexpr double kSureEnough = 0.6;

bool any_sure(const Examination& x) {
  for (const ActiveEffect& effect : x.named)
    if (x.probability_of(effect) >= kSureEnough) return true;
  return false;
}

}  // namespace

void judge(Examination& x) {
  Diagnosis& report = x.report;
  const Leftover leftover = find_leftover(x.id, x.id.explanations.front().columns);
  report.leftover_significant = leftover.significant;
  report.leftover_share = leftover.share;
  report.leftover_description = leftover.description;
  if (x.few) {
    report.verdict = Verdict::too_little_data;
    x.named.clear();
    report.notes.push_back("fewer than " + std::to_string(kLeastRuns) +
                           " runs: candidates only; add runs with two payloads, both directions and turns");
  } else if (x.named.empty()) {
    report.verdict = leftover.significant ? Verdict::unexplained : Verdict::no_gap;
  } else if (leftover.significant && leftover.share > kUnexplainedShare) {
    report.verdict = Verdict::unexplained;
    x.named.clear();
  } else {
    report.verdict = leftover.significant ? Verdict::partly_explained : Verdict::explained;
  }
  judge_forms(x);
  if (!x.named.empty() && !any_sure(x) && report.verdict == Verdict::explained)
    report.verdict = Verdict::ambiguous;
}

}  // namespace joulepath
