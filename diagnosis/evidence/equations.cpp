#include "diagnosis/evidence/equations.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/signals/manoeuvres.hpp"
#include "diagnosis/signals/resolution.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0503-evidence.md,
// docs/decisions/0501-motion.md
namespace joulepath {
namespace {

/// Rows of one run before whitening.
struct RunRows {
  ResidualRows residual{};
  std::vector<Eigen::MatrixXd> columns{};
  std::vector<Eigen::MatrixXd> own{};
};

/// The state's effects come first, each in place of the catalog's candidates of the same name and side.
std::vector<Candidate> candidates_about(const Robot& robot, const ModelState& state,
                                        const std::vector<Candidate>& extra, const EquationOptions& options) {
  std::vector<Candidate> list;
  for (const ActiveEffect& effect : state.effects) list.push_back(effect.candidate);
  const std::size_t active = list.size();
  const auto add = [&](const Candidate& candidate) {
    for (std::size_t k = 0; k < active; ++k)
      if (list[k].label() == candidate.label()) return;
    list.push_back(candidate);
  };
  if (options.whole_catalog)
    for (const Candidate& candidate : catalog_candidates(robot, options.without)) add(candidate);
  for (const Candidate& candidate : extra) add(candidate);
  return list;
}

std::string label_of(const DictionaryEntry& entry) { return entry.family + " (" + entry.channel + ")"; }

/// Places of the dictionary's entries that take part.
std::vector<std::size_t> chosen_entries(const std::vector<DictionaryEntry>& entries,
                                        const EquationOptions& options) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < entries.size(); ++k)
    if (options.dictionary || options.unknowns.contains(label_of(entries[k]))) chosen.push_back(k);
  return chosen;
}

/// Errors of time stamps or of a winding's inductance correlate voltage with acceleration: no finding.
constexpr const char* kOfTheLogger = "acceleration (voltage)";

/// Entries of one family and channel are one unknown term, without those that a candidate's law is. A curve
/// over one payload is a constant.
std::vector<UnknownTerm> unknown_terms(const std::vector<Column>& columns,
                                       const std::vector<DictionaryEntry>& dictionary,
                                       const std::vector<Candidate>& candidates, bool two_payloads) {
  std::vector<UnknownTerm> terms;
  const auto is_known = [&](const std::string& curve) {
    return !curve.empty() && std::ranges::any_of(candidates, [&](const Candidate& candidate) {
      return candidate.effect().info.curve == curve;
    });
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].kind != Column::Kind::dictionary) continue;
    const DictionaryEntry& entry = dictionary[static_cast<std::size_t>(columns[k].owner)];
    const std::string label = label_of(entry);
    if (label == kOfTheLogger || is_known(entry.curve) || (!two_payloads && entry.family == "payload"))
      continue;
    const auto known = std::ranges::find(terms, label, &UnknownTerm::label);
    if (known == terms.end())
      terms.push_back({label, {static_cast<int>(k)}});
    else
      known->columns.push_back(static_cast<int>(k));
  }
  return terms;
}

/// Parameters are absolute: the part that the state already explains is added.
void make_absolute(const std::vector<Column>& columns, RunRows& rows) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].current != 0) rows.residual.value += columns[k].current * rows.columns[k];
}

/// all' all, channel by channel: in most channels most columns are zero and take no part.
Eigen::MatrixXd products_by_channel(const Eigen::MatrixXd& all, const std::vector<int>& channel_of_entry) {
  std::array<std::vector<Eigen::Index>, kChannelCount> entries{};
  for (std::size_t e = 0; e < channel_of_entry.size(); ++e)
    entries[static_cast<std::size_t>(channel_of_entry[e])].push_back(static_cast<Eigen::Index>(e));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(all.cols(), all.cols());
  for (const std::vector<Eigen::Index>& of_channel : entries) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index c = 0; c < all.cols(); ++c)
      if ((all.col(c)(of_channel).array() != 0).any()) columns.push_back(c);
    if (columns.empty()) continue;
    const Eigen::MatrixXd part = all(of_channel, columns);
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(part.cols(), part.cols());
    product.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    product.triangularView<Eigen::StrictlyUpper>() = product.transpose();
    sum(columns, columns) += product;
  }
  return sum;
}

RawRunEquations compress(const RunRows& rows, const NoiseModel& noise) {
  const Whitener whiten(noise, rows.residual.present);
  const auto p = static_cast<Eigen::Index>(rows.columns.size()),
             k = static_cast<Eigen::Index>(rows.own.size());
  Eigen::MatrixXd all(whiten.entries(), p + k + 1);
  for (Eigen::Index c = 0; c < p; ++c) all.col(c) = whiten(rows.columns[static_cast<std::size_t>(c)]);
  for (Eigen::Index c = 0; c < k; ++c) all.col(p + c) = whiten(rows.own[static_cast<std::size_t>(c)]);
  all.col(p + k) = whiten(rows.residual.value);
  return {.gram = products_by_channel(all, whiten.channel_of_entry()), .columns = p, .own_columns = k};
}

std::vector<RawRunEquations> compress_all(const std::vector<RunRows>& rows, const NoiseModel& noise) {
  std::vector<RawRunEquations> raw(rows.size());
  parallel_for(rows.size(), [&](std::size_t r) { raw[r] = compress(rows[r], noise); });
  return raw;
}

std::vector<RunEquations> marginalize_all(const std::vector<RawRunEquations>& raw,
                                          const Eigen::VectorXd& variance) {
  std::vector<RunEquations> runs(raw.size());
  parallel_for(raw.size(), [&](std::size_t r) { runs[r] = marginalize(raw[r], variance); });
  return runs;
}

/// The fit of everything at once: its residual counts as noise.
ColumnEstimate rich_estimate(const std::vector<RunEquations>& runs, const Eigen::VectorXd& prior_sd) {
  const LinearProblem problem = sum_runs(runs, every(runs.size()), prior_sd);
  std::vector<int> columns(static_cast<std::size_t>(prior_sd.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) columns[k] = static_cast<int>(k);
  Posterior posterior = solve(problem, columns);
  return {std::move(posterior.mean), std::move(posterior.covariance)};
}

std::vector<ResidualRows> leftover_rows(const std::vector<RunRows>& rows, const Eigen::VectorXd& estimate,
                                        const std::vector<RawRunEquations>& raw,
                                        const Eigen::VectorXd& variance) {
  std::vector<ResidualRows> left(rows.size());
  parallel_for(rows.size(), [&](std::size_t r) {
    left[r] = rows[r].residual;
    for (Eigen::Index k = 0; k < estimate.size(); ++k)
      left[r].value -= estimate[k] * rows[r].columns[static_cast<std::size_t>(k)];
    const Eigen::Index p = raw[r].columns, q = raw[r].own_columns;
    const Eigen::VectorXd own_right =
        raw[r].gram.block(p, p + q, q, 1) - raw[r].gram.block(p, 0, q, p) * estimate;
    Eigen::MatrixXd precision = raw[r].gram.block(p, p, q, q);
    for (Eigen::Index k = 0; k < q; ++k) precision(k, k) += 1.0 / std::max(variance[k], 1e-12);
    const Eigen::VectorXd own = Eigen::LDLT<Eigen::MatrixXd>(precision).solve(own_right);
    for (Eigen::Index k = 0; k < q; ++k) left[r].value -= own[k] * rows[r].own[static_cast<std::size_t>(k)];
  });
  return left;
}

/// Dictionary entries have no size of their own: the prior lets each explain what the data show.
void set_dictionary_prior(const std::vector<RawRunEquations>& raw, std::vector<Column>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].kind != Column::Kind::dictionary) continue;
    const auto i = static_cast<Eigen::Index>(k);
    double square = 0, residual = 0;
    for (const RawRunEquations& run : raw) {
      square += run.gram(i, i);
      residual += run.gram(run.gram.rows() - 1, run.gram.cols() - 1);
    }
    columns[k].prior_sd = square > 0 ? kUnknownPrior * std::sqrt(residual / square) : 1e-9;
  }
}

Eigen::VectorXd prior_sd_of(const std::vector<Column>& columns) {
  Eigen::VectorXd sd(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) sd[static_cast<Eigen::Index>(k)] = columns[k].prior_sd;
  return sd;
}

/// Left and right are of the same make: they share the variance.
Eigen::VectorXd shared_sides(Eigen::VectorXd variance) {
  variance[0] = variance[1] = 0.5 * (variance[0] + variance[1]);
  variance[2] = variance[3] = 0.5 * (variance[2] + variance[3]);
  return variance;
}

/// A payload that no file states is a parameter of its run.
bool has_payload_column(const std::vector<RunSignals>& signals, const EquationOptions& options,
                        const Robot& robot) {
  if (options.run_variance) return options.run_variance->size() > run_start_variance(robot).size();
  return std::ranges::any_of(signals, [](const RunSignals& run) { return !run.payload_known; });
}

/// Residuals of one run, and signatures for its motion as `moves` has it.
RunRows rows_of(const RunSignals& signals, const RunSignals& moves, const Robot& robot,
                const std::vector<Nuisance>& nuisances, const ModelState& state, const Equations& equations,
                const DictionaryLayout& layout, const std::vector<std::size_t>& chosen, bool payload_column) {
  const ModelPoint point = model_point(robot, nuisances, state);
  const Prediction base = predict(moves, point);
  RunRows rows{
      .residual = residual_rows(signals, point, predict(signals, point)),
      .columns = signatures(moves, robot, nuisances, state, equations.candidates, equations.columns, base),
      .own = run_signatures(moves, robot, base)};
  if (payload_column) rows.own.push_back(payload_signature(moves, point, base));
  if (!chosen.empty()) {
    std::vector<Eigen::MatrixXd> all = dictionary_rows(layout, moves, robot, base);
    for (std::size_t k : chosen) rows.columns.push_back(std::move(all[k]));
  }
  make_absolute(equations.columns, rows);
  return rows;
}

/// Noise and scatter of runs from the residual of a fit of everything. The gap itself must not count as
/// noise: the first fit assumes white rows, and only the residual determines the memory.
std::vector<RawRunEquations> compress_and_estimate(const std::vector<RunRows>& rows,
                                                   const std::vector<RunSignals>& signals, const Robot& robot,
                                                   const NoiseModel* first_noise, bool payload_column,
                                                   Equations& equations) {
  std::vector<ResidualRows> left(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) left[r] = rows[r].residual;
  const std::array<double, kChannelCount> floor = resolution_floor(signals);
  equations.noise = first_noise ? *first_noise : white_noise(left, floor);
  const Eigen::VectorXd start = run_start_variance(robot);
  const Eigen::Index payloads = payload_column ? 1 : 0, given = kGivenRunVariances + payloads;
  equations.run_variance.resize(start.size() + payloads);
  equations.run_variance << start,
      Eigen::VectorXd::Constant(payloads, std::pow(payload_prior_sd_kg(robot), 2));
  for (int pass = first_noise ? 1 : 0;; ++pass) {
    std::vector<RawRunEquations> raw = compress_all(rows, equations.noise);
    set_dictionary_prior(raw, equations.columns);
    const ColumnEstimate estimate =
        rich_estimate(marginalize_all(raw, equations.run_variance), prior_sd_of(equations.columns));
    equations.run_variance = shared_sides(run_variances(raw, estimate, equations.run_variance, given));
    if (pass == 2) return raw;
    left = leftover_rows(rows, estimate.mean, raw, equations.run_variance);
    equations.noise = estimate_noise(left, floor);
  }
}

}  // namespace

std::vector<int> Equations::columns_of(Column::Kind kind) const {
  std::vector<int> found;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].kind == kind) found.push_back(static_cast<int>(k));
  return found;
}

std::vector<int> Equations::columns_of_candidate(int candidate, bool with_shapes) const {
  std::vector<int> found;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].owner == candidate &&
        (columns[k].kind == Column::Kind::amplitude ||
         (with_shapes && (columns[k].kind == Column::Kind::shape || columns[k].kind == Column::Kind::form))))
      found.push_back(static_cast<int>(k));
  return found;
}

Equations build_equations(const std::vector<RunSignals>& signals, const Robot& robot,
                          const std::vector<Nuisance>& nuisances, const ModelState& state,
                          const std::vector<Candidate>& extra, const EquationOptions& options) {
  Equations equations{.candidates = candidates_about(robot, state, extra, options)};
  const DictionaryLayout layout = lay_out(signals, robot);
  const std::vector<DictionaryEntry> entries = dictionary_entries(layout);
  const std::vector<std::size_t> chosen = chosen_entries(entries, options);
  for (std::size_t k : chosen) equations.dictionary.push_back(entries[k]);
  equations.columns =
      list_columns(nuisances, state, equations.candidates, equations.dictionary.size(), options.forms);
  equations.unknowns =
      unknown_terms(equations.columns, equations.dictionary, equations.candidates, has_two_payloads(signals));

  std::vector<RunRows> rows(signals.size());
  const bool payload_column = has_payload_column(signals, options, robot);
  const bool straight = !has_yaw(signals, robot.geometry);
  parallel_for(signals.size(), [&](std::size_t r) {
    const auto rows_for = [&](const RunSignals& moves) {
      return rows_of(signals[r], moves, robot, nuisances, state, equations, layout, chosen, payload_column);
    };
    rows[r] = rows_for(straight ? straightened(signals[r]) : straightened_where_straight(signals[r]));
  });
  std::vector<RawRunEquations> raw;
  if (options.noise) {
    equations.noise = *options.noise;
    equations.run_variance = *options.run_variance;
    raw = compress_all(rows, equations.noise);
    set_dictionary_prior(raw, equations.columns);
  } else {
    raw = compress_and_estimate(rows, signals, robot, options.first_noise, payload_column, equations);
  }
  equations.runs = marginalize_all(raw, equations.run_variance);
  equations.prior_sd = prior_sd_of(equations.columns);
  return equations;
}

}  // namespace joulepath
