#include "diagnosis/verdict/forms.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/verdict/names.hpp"

namespace joulepath {
namespace {

/// 99.3 % and 93 % of a chi-squared of 5 degrees: laws bent by a little more than usual are common.
constexpr double kAnotherLaw = 16.0;
constexpr double kInexactLaw = 10.0;

/// Share of the evidence below which a doubtful effect is dropped alone.
constexpr double kMinorGain = 0.05;

const std::set<std::string> kSpeedLaws{"coulomb_friction", "viscous_friction", "stribeck_friction",
                                       "quadratic_drag"};
/// Their strength at small yaw rates depends on how the law passes through zero, which logs do not show:
/// the yaw rate says nothing against them, and other forms only that they explain a part.
const std::set<std::string> kTurningLaws{"turning_scrub", "caster_swivel"};

/// Below this evidence, a wrong law is no more than scatter that looks like one.
constexpr double kLeastEvidence = 25.0;
constexpr double kLeastEvidenceOfFewRuns = 100.0;

void withdraw(Examination& x, const std::string& note, const std::string& depends_on) {
  x.report.notes.push_back(note);
  x.named.clear();
  const double least =
      x.diagnosis.runs.size() < kRunsForSmallEffects ? kLeastEvidenceOfFewRuns : kLeastEvidence;
  if (x.id.explanations.front().score < least && !x.report.leftover_significant) {
    x.report.verdict = Verdict::no_gap;
    return;
  }
  x.report.verdict = Verdict::unexplained;
  x.report.leftover_significant = true;
  x.report.leftover_description = depends_on;
}

}  // namespace

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

bool draws_a_friction_curve(const std::vector<ActiveEffect>& named) {
  return std::count_if(named.begin(), named.end(), [](const ActiveEffect& effect) {
           return kSpeedLaws.contains(effect.candidate.shape.name);
         }) > 1;
}

void judge_forms(Examination& x) {
  if (draws_a_friction_curve(x.named)) {
    withdraw(x, "only several laws of friction against speed together make up the gap: none is named",
             "depends on wheel speed (current)");
    return;
  }
  for (const ActiveEffect& effect : std::vector<ActiveEffect>(x.named)) {
    const FormDoubt doubt = form_doubt(x.id, effect.candidate.label());
    if (doubt.chi_squared < kInexactLaw) continue;
    const std::string text = effect.candidate.label() + " fits only with a strength that depends on " +
                             doubt.depends_on + ", as the catalog's law does not";
    if (x.named.size() > 1 && gain_share_of(x, effect.candidate.label()) < kMinorGain) {
      x.report.notes.push_back(text + ": not named beside a greater effect");
      std::erase_if(x.named,
                    [&](const ActiveEffect& e) { return e.candidate.label() == effect.candidate.label(); });
      continue;
    }
    if (doubt.chi_squared > kAnotherLaw && !kTurningLaws.contains(effect.candidate.shape.name)) {
      withdraw(x, text, "depends on " + doubt.depends_on);
      return;
    }
    x.report.notes.push_back(text);
    x.report.verdict = Verdict::partly_explained;
    if (x.report.leftover_description.empty())
      x.report.leftover_description = "depends on " + doubt.depends_on;
  }
}

}  // namespace joulepath
