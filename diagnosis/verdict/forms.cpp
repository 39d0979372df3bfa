#include "diagnosis/verdict/forms.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

const std::set<std::string> kSpeedLaws{"coulomb_friction", "viscous_friction", "stribeck_friction",
                                       "quadratic_drag"};
/// Their strength at small yaw rates depends on how the law passes through zero, which logs do not show:
/// the yaw rate says nothing against them, and other forms only that they explain a part.
const std::set<std::string> kTurningLaws{"turning_scrub", "caster_swivel"};

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

/// How far the data pull a law away from the catalog's form. Each effect's strength may vary with speed,
/// yaw rate, payload, acceleration and time of day by a share that laws are usually inexact by; the sum
/// of squares of what the data ask for, in those shares, is chi-squared with 5 degrees for a true law.
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
    if (candidate.label() != label || (yaw && kTurningLaws.contains(candidate.shape.name))) continue;
    const double pull = best.mean[static_cast<Eigen::Index>(k)] / column.prior_sd;
    doubt.chi_squared += pull * pull;
    if (pull * pull <= most) continue;
    most = pull * pull;
    doubt.depends_on = kFormVariables[static_cast<std::size_t>(column.part)];
  }
  return doubt;
}

/// True where two or more of the names are laws of friction against speed: together they can draw any
/// such curve, and stand for one that the catalog does not have.
bool draws_a_friction_curve(const std::vector<ActiveEffect>& named) {
  return std::count_if(named.begin(), named.end(), [](const ActiveEffect& effect) {
           return kSpeedLaws.contains(effect.candidate.shape.name);
         }) > 1;
}

}  // namespace

Judgment judge_forms(const Examination& x, Judgment judgment) {
  if (draws_a_friction_curve(judgment.named))
    return withdrawn(x, std::move(judgment),
                     "only several laws of friction against speed together make up the gap: none is named",
                     "depends on wheel speed (current)");
  for (const ActiveEffect& effect : std::vector<ActiveEffect>(judgment.named)) {
    const std::string label = effect.candidate.label();
    const FormDoubt doubt = form_doubt(x.id, label);
    if (doubt.chi_squared < kInexactLaw) continue;
    const std::string text = label + " fits only with a strength that depends on " + doubt.depends_on +
                             ", as the catalog's law does not";
    if (judgment.named.size() > 1 && gain_share_of(x, label) < kMinorGain) {
      judgment.notes.push_back(text + ": not named beside a greater effect");
      std::erase_if(judgment.named, [&](const ActiveEffect& e) { return e.candidate.label() == label; });
      continue;
    }
    if (doubt.chi_squared > kAnotherLaw && !kTurningLaws.contains(effect.candidate.shape.name))
      return withdrawn(x, std::move(judgment), text, "depends on " + doubt.depends_on);
    judgment.notes.push_back(text);
    judgment.verdict = Verdict::partly_explained;
    if (judgment.leftover.description.empty())
      judgment.leftover.description = "depends on " + doubt.depends_on;
  }
  return judgment;
}

}  // namespace joulepath
