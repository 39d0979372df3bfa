#include "diagnosis/verdict/forms.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0043-small-effects-and-foreign-forms.md
namespace joulepath {
namespace {

/// Logs do not show how these laws pass through zero: the yaw rate says nothing against them, and other
/// forms say only that they explain a part.
bool vague_at_slow_turns(const Candidate& candidate) {
  return candidate.effect().info.pliability == Pliability::slow_turns;
}

Judgment withdrawn(const Examination& x, Judgment judgment, const std::string& note,
                   const std::string& depends_on) {
  judgment.notes.push_back(note);
  judgment.named.clear();
  const double least =
      x.runs.diagnosis.runs.size() < kRunsForSmallEffects ? kWrongLawEvidenceOfFewRuns : kWrongLawEvidence;
  if (x.best().score < least && !judgment.leftover.significant) {
    judgment.verdict = Verdict::no_gap;
    return judgment;
  }
  judgment.verdict = Verdict::unexplained;
  judgment.leftover.significant = true;
  judgment.leftover.description = depends_on;
  return judgment;
}

/// Deviation of a law from the catalog's form in the data. Each effect's strength may vary with speed,
/// yaw rate, payload, acceleration and time of day by the typical error of a law's form; the sum
/// of squares of the fitted variations, in units of that error, is chi-squared with 5 degrees for a true law.
struct FormDoubt {
  double chi_squared{};
  std::string depends_on{};  ///< what the strength varies with most
};

FormDoubt form_doubt(const Identification& id, const std::string& label) {
  FormDoubt doubt;
  const Explanation& best = id.explanations.front();
  double most = 0;
  for (std::size_t k = 0; k < best.columns.size(); ++k) {
    const Column& column = id.equations.columns[static_cast<std::size_t>(best.columns[k])];
    if (column.kind != Column::Kind::form) continue;
    const Candidate& candidate = id.equations.candidates[static_cast<std::size_t>(column.owner)];
    const bool yaw = kFormVariables[static_cast<std::size_t>(column.part)] == "yaw rate";
    if (candidate.label() != label || (yaw && vague_at_slow_turns(candidate))) continue;
    const double pull = best.mean[static_cast<Eigen::Index>(k)] / column.prior_sd;
    doubt.chi_squared += pull * pull;
    if (pull * pull <= most) continue;
    most = pull * pull;
    doubt.depends_on = kFormVariables[static_cast<std::size_t>(column.part)];
  }
  return doubt;
}

/// The family that two or more of the names belong to: together they can draw any such curve, and stand for
/// one that the catalog does not have. Without a name where there is none.
LawFamily family_that_draws_a_curve(const std::vector<ActiveEffect>& named) {
  std::set<std::string_view> met;
  for (const ActiveEffect& effect : named) {
    const LawFamily& family = effect.candidate.effect().info.family;
    if (!family.name.empty() && !met.insert(family.name).second) return family;
  }
  return {};
}

}  // namespace

Judgment judge_forms(const Examination& x, Judgment judgment) {
  if (const LawFamily family = family_that_draws_a_curve(judgment.named); !family.name.empty())
    return withdrawn(
        x, std::move(judgment),
        "only several laws of " + std::string(family.name) + " together make up the gap: none is named",
        "depends on " + std::string(family.variable) + " (current)");
  for (const ActiveEffect& effect : std::vector<ActiveEffect>(judgment.named)) {
    const std::string label = effect.candidate.label();
    const FormDoubt doubt = form_doubt(x.id, label);
    if (doubt.chi_squared < kInexactLaw) continue;
    const std::string text = label + " fits only with a strength that depends on " + doubt.depends_on +
                             ", which the catalog's law does not have";
    if (judgment.named.size() > 1 && gain_share_of(x, label) < kMinorGain) {
      judgment.notes.push_back(text + ": not named, small compared with a greater effect");
      std::erase_if(judgment.named, [&](const ActiveEffect& e) { return e.candidate.label() == label; });
      continue;
    }
    if (doubt.chi_squared > kAnotherLaw && !vague_at_slow_turns(effect.candidate))
      return withdrawn(x, std::move(judgment), text, "depends on " + doubt.depends_on);
    judgment.notes.push_back(text);
    judgment.verdict = Verdict::partly_explained;
    if (judgment.leftover.description.empty())
      judgment.leftover.description = "depends on " + doubt.depends_on;
  }
  return judgment;
}

}  // namespace joulepath
