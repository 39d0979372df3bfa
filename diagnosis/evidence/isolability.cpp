#include "diagnosis/evidence/isolability.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "diagnosis/checks/survey.hpp"
#include "diagnosis/evidence/linear_fit.hpp"
#include "diagnosis/evidence/power.hpp"
#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0508-what-runs-can-show.md
namespace joulepath {
namespace {

ModelState nominal_state(const std::vector<Nuisance>& nuisances) {
  return {.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)};
}

/// The candidates of one label: one for each value of the grid over its shape parameters.
struct Hypothesis {
  std::string label{};
  std::vector<int> candidates{};
  int typical{};  ///< of them, the one whose shape is nearest to the typical one
};

/// How far a candidate's shape is from the typical one.
double shape_distance(const Candidate& candidate, const Robot& robot) {
  double sum = 0;
  for (const ParameterDescription& parameter : candidate.effect().parameters)
    if (parameter.role == ParameterRole::shape) {
      const double typical = typical_size(parameter, robot);
      sum += std::abs(candidate.shape.parameters.at(parameter.name) / typical - 1);
    }
  return sum;
}

std::vector<Hypothesis> hypotheses_of(const Equations& equations, const Robot& robot) {
  std::vector<Hypothesis> list;
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    const std::string label = equations.candidates[c].label();
    if (list.empty() || list.back().label != label) list.push_back({label, {}, static_cast<int>(c)});
    Hypothesis& own = list.back();
    own.candidates.push_back(static_cast<int>(c));
    if (shape_distance(equations.candidates[c], robot) <
        shape_distance(equations.candidates[static_cast<std::size_t>(own.typical)], robot))
      own.typical = static_cast<int>(c);
  }
  return list;
}

/// Data without noise: those of one amplitude of one effect at its typical size.
struct Truth {
  int column{};
  double amplitude{};
};

/// Fits of rivals to the data of one truth. Only the right-hand sides differ from rival to rival.
class RivalFits {
 public:
  RivalFits(const LinearProblem& problem, const Equations& equations, const Robot& robot, double dispersion,
            const Truth& truth)
      : problem_(problem),
        equations_(equations),
        robot_(robot),
        dispersion_(dispersion),
        change_{{truth.column, truth.amplitude}} {}

  /// Loss of the best fit of a candidate.
  double loss(int rival) {
    const std::vector<int> amplitudes = equations_.columns_of_candidate(rival, false);
    const Candidate& candidate = equations_.candidates[static_cast<std::size_t>(rival)];
    set_data({});
    for (int k : amplitudes) problem_.prior_sd[k] = kFreeAmplitude * equations_.prior_sd[k];
    const Posterior free = solve(problem_, amplitudes, dispersion_, false);
    std::vector<double> size(free.mean.begin(), free.mean.end());
    const bool inside = accept(candidate, size);
    std::map<int, double> fixed;
    for (std::size_t part = 0; part < size.size(); ++part)
      if (!inside) fixed[amplitudes[part]] = size[part];
    set_data(fixed);
    std::vector<int> columns = inside ? amplitudes : std::vector<int>{};
    for (int k : equations_.columns_of_candidate(rival, true)) {
      const Column& column = equations_.columns[static_cast<std::size_t>(k)];
      if (column.kind != Column::Kind::form) continue;
      const auto part = static_cast<std::size_t>(column.part) / kFormVariables.size();
      problem_.prior_sd[k] = equations_.prior_sd[k] * std::abs(size[part]) / candidate.step[part];
      columns.push_back(k);
    }
    return solve(problem_, columns, dispersion_, false).loss;
  }

 private:
  /// The truth's data less a rival's part that is fixed.
  void set_data(const std::map<int, double>& fixed) {
    std::map<int, double> change = change_;
    for (const auto& [column, amplitude] : fixed) change[column] -= amplitude;
    problem_.right.setZero();
    problem_.residual_square = 0;
    for (const auto& [column, amplitude] : change) problem_.right += amplitude * problem_.gram.col(column);
    for (const auto& [column, amplitude] : change)
      problem_.residual_square += amplitude * problem_.right[column];
  }

  /// The nearest amplitudes that physics and the catalog accept; true if these already are.
  bool accept(const Candidate& candidate, std::vector<double>& size) const {
    if (candidate.nonnegative && size[0] < 0) {
      size[0] = 0;
      return false;
    }
    if (outside_range(candidate, size, robot_) <= 1e-6 * candidate.step[0]) return true;
    size = amplitudes_of(setting_of(candidate, size, robot_), robot_);
    return false;
  }

  LinearProblem problem_;
  const Equations& equations_;
  const Robot& robot_;
  double dispersion_;
  std::map<int, double> change_{};
};

/// All that the pairs need.
struct Design {
  const Equations& equations;
  const LinearProblem problem;
  const Robot& robot;
  double dispersion;
};

/// The typical sizes of a hypothesis: of either sign, unless physics allows one only.
std::vector<std::vector<Truth>> truths_of(const Design& design, const Hypothesis& hypothesis) {
  const Candidate& candidate = design.equations.candidates[static_cast<std::size_t>(hypothesis.typical)];
  const std::vector<int> columns = design.equations.columns_of_candidate(hypothesis.typical, false);
  std::vector<std::vector<Truth>> parts;
  for (std::size_t part = 0; part < columns.size(); ++part) {
    parts.push_back({{columns[part], candidate.step[part]}});
    if (!candidate.nonnegative) parts.back().push_back({columns[part], -candidate.step[part]});
  }
  return parts;
}

/// Expected 2 ln LR of a hypothesis against each: of two components (an unknown direction) the mean, of two
/// signs the lesser.
std::vector<double> ratios_against(const Design& design, const Hypothesis& own,
                                   const std::vector<Hypothesis>& all) {
  std::vector<double> mean(all.size(), 0.0);
  const std::vector<std::vector<Truth>> parts = truths_of(design, own);
  for (const std::vector<Truth>& signs : parts) {
    std::vector<double> least(all.size(), 1e300);
    for (const Truth& truth : signs) {
      RivalFits fits(design.problem, design.equations, design.robot, design.dispersion, truth);
      for (std::size_t k = 0; k < all.size(); ++k)
        if (all[k].label != own.label)
          for (int rival : all[k].candidates) least[k] = std::min(least[k], fits.loss(rival));
    }
    for (std::size_t k = 0; k < all.size(); ++k) mean[k] += least[k] / static_cast<double>(parts.size());
  }
  return mean;
}

double sigmas_per_amplitude(const Design& design, int column) {
  return std::sqrt(design.problem.gram(column, column) / design.dispersion);
}

double probability_seen(const Design& design, const Hypothesis& hypothesis) {
  double sum = 0;
  const std::vector<std::vector<Truth>> parts = truths_of(design, hypothesis);
  for (const std::vector<Truth>& signs : parts) {
    const int column = signs.front().column;
    const double sigmas = sigmas_per_amplitude(design, column);
    sum += probability_taken_up(signs.front().amplitude * sigmas, design.equations.prior_sd[column] * sigmas);
  }
  return sum / static_cast<double>(parts.size());
}

/// The strength from which on an effect of typical shape would be seen, of two components in either
/// direction; none where the catalog does not accept it.
std::optional<Isolability::Strength> seen_from(const Design& design, const Hypothesis& hypothesis) {
  const Candidate& candidate = design.equations.candidates[static_cast<std::size_t>(hypothesis.typical)];
  std::vector<double> amplitude(candidate.amplitude.size(), 0.0);
  for (int column : design.equations.columns_of_candidate(hypothesis.typical, false)) {
    const double sigmas = sigmas_per_amplitude(design, column);
    if (sigmas <= 0) return std::nullopt;
    const double least = sigmas_seen(design.equations.prior_sd[column] * sigmas) / sigmas;
    amplitude[0] = std::max(amplitude[0], least);
  }
  if (outside_range(candidate, amplitude, design.robot) > 1e-6 * candidate.step[0]) return std::nullopt;
  const std::string& strength = candidate.effect().strength().name;
  return Isolability::Strength{strength,
                               setting_of(candidate, amplitude, design.robot).parameters.at(strength)};
}

std::vector<Hypothesis> seen_of(const Isolability& found, const std::vector<Hypothesis>& all) {
  std::vector<Hypothesis> seen;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (found.effects[k].probability_seen >= kShareSeen) seen.push_back(all[k]);
  return seen;
}

void add_pairs(const Design& design, const std::vector<Hypothesis>& seen, Isolability& found) {
  std::vector<std::vector<double>> ratio(seen.size());
  parallel_for(seen.size(), [&](std::size_t k) { ratio[k] = ratios_against(design, seen[k], seen); });
  for (std::size_t a = 0; a < seen.size(); ++a)
    for (std::size_t b = a + 1; b < seen.size(); ++b) {
      const double least = std::min(ratio[a][b], ratio[b][a]);
      found.pairs.push_back({seen[a].label, seen[b].label, least, probability_told_apart(least)});
    }
}

}  // namespace

RunNoise noise_of_runs(const std::vector<RunSignals>& signals, const Robot& robot,
                       const std::set<std::string>& without) {
  const std::vector<Nuisance> nuisances = calibration_nuisances(robot);
  const Equations equations =
      build_equations(signals, robot, nuisances, nominal_state(nuisances), {}, {.without = without});
  return {equations.noise, equations.run_variance, run_dispersion(equations, rich_columns(equations))};
}

Isolability isolability(const std::vector<RunSignals>& signals, const Robot& robot, const RunNoise& noise,
                        const std::set<std::string>& invisible, const std::set<std::string>& without,
                        const std::set<std::string>& found) {
  const std::vector<Nuisance> nuisances = calibration_nuisances(robot);
  const Equations equations = build_equations(signals, robot, nuisances, nominal_state(nuisances), {},
                                              {.dictionary = false,
                                               .forms = Forms::all,
                                               .noise = &noise.noise,
                                               .run_variance = &noise.run_variance,
                                               .without = without});
  const Design design{equations, without_calibration(equations, every(signals.size()), noise.dispersion),
                      robot, noise.dispersion};
  const std::vector<Hypothesis> all = hypotheses_of(equations, robot);
  Isolability shown;
  for (const Hypothesis& hypothesis : all) {
    Isolability::Effect& effect = shown.effects.emplace_back(
        Isolability::Effect{.effect = hypothesis.label, .is_found = found.contains(hypothesis.label)});
    const Candidate& candidate = equations.candidates[static_cast<std::size_t>(hypothesis.typical)];
    if (invisible.contains(candidate.shape.name)) continue;
    effect.probability_seen = probability_seen(design, hypothesis);
    effect.seen_from = seen_from(design, hypothesis);
  }
  add_pairs(design, seen_of(shown, all), shown);
  return shown;
}

Isolability isolability(const Dataset& dataset, const RunsByUse& runs) {
  const std::vector<RunSignals> signals = read_signals(runs.diagnosis, 0.0);
  const std::set<std::string> invisible = survey_dataset(dataset, runs.signals).invisible_effects;
  return isolability(signals, dataset.robot, noise_of_runs(signals, dataset.robot, invisible), invisible);
}

}  // namespace joulepath
