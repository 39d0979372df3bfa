#include "diagnosis/correction/ceiling.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/where/gap.hpp"

// Method: [HoerlKennard1970]
namespace joulepath {
namespace {

constexpr double kRidges[] = {0.0, 0.01, 0.03, 0.1, 0.3, 1.0};  ///< widths of the dictionary's prior

/// The named effects (none where nothing is named) with the whole dictionary.
std::vector<int> flexible_columns(const Examination& x, bool any_named) {
  std::vector<int> columns;
  if (any_named)
    std::ranges::copy_if(x.best().columns, std::back_inserter(columns), [&](int k) {
      return x.id.equations.columns[static_cast<std::size_t>(k)].kind != Column::Kind::dictionary;
    });
  const std::vector<int> dictionary = x.id.equations.columns_of(Column::Kind::dictionary);
  columns.insert(columns.end(), dictionary.begin(), dictionary.end());
  return columns;
}

Equations with_ridge(Equations equations, double width) {
  for (int k : equations.columns_of(Column::Kind::dictionary)) equations.prior_sd[k] *= width;
  return equations;
}

/// Loss of diagnosis runs under fits without them.
double left_out_loss(const Equations& equations, const std::vector<int>& columns, double dispersion) {
  double loss = 0;
  for (std::size_t fold = 0; fold < kRidgeFolds; ++fold) {
    std::vector<std::size_t> fitted, judged;
    for (std::size_t r = 0; r < equations.runs.size(); ++r)
      (r % kRidgeFolds == fold ? judged : fitted).push_back(r);
    const Eigen::VectorXd parameters = fit_parameters(equations, fitted, columns, dispersion);
    for (std::size_t r : judged) loss += run_loss(equations.runs[r], parameters);
  }
  return loss;
}

/// The equations with the ridge that left-out runs like best.
Equations ridged(const Identification& id, const std::vector<int>& columns) {
  Equations best = with_ridge(id.equations, kRidges[0]);
  double least = left_out_loss(best, columns, id.dispersion);
  for (std::size_t k = 1; k < std::size(kRidges); ++k) {
    Equations equations = with_ridge(id.equations, kRidges[k]);
    const double loss = left_out_loss(equations, columns, id.dispersion);
    if (loss < least) least = loss, best = std::move(equations);
  }
  return best;
}

/// What the dictionary adds to a run's structured rows.
Eigen::MatrixXd dictionary_part(const Identification& id, const DictionaryLayout& layout,
                                const Eigen::VectorXd& parameters, const RunSignals& run, const Robot& robot,
                                const Prediction& prediction) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(run.size(), kChannelCount);
  const std::vector<Eigen::MatrixXd> entries = dictionary_rows(layout, run, robot, prediction);
  for (int k : id.equations.columns_of(Column::Kind::dictionary))
    sum += parameters[k] *
           entries[static_cast<std::size_t>(id.equations.columns[static_cast<std::size_t>(k)].owner)];
  return sum;
}

/// Predicted less measured energy (J) of a run, dictionary included.
double flexible_gap_J(const RunSignals& run, const Prediction& p, const Eigen::MatrixXd& added) {
  double gap_J = 0;
  for (Side side : kSides) {
    const Eigen::VectorXd measured_W = measured_power_W(run, side);
    if (measured_W.size() == 0) continue;
    const int s = side == Side::left ? 0 : 1;
    const Eigen::VectorXd current_A = added.col(kCurrentLeft + s);
    const Eigen::VectorXd voltage_V =
        added.col(kWindingLeft + s) + p.reading_resistance_ohm[side].cwiseProduct(current_A);
    gap_J += run.period_s *
             ((p.voltage_V[side] + voltage_V).dot(p.current_A[side] + current_A) - measured_W.sum());
  }
  return gap_J;
}

}  // namespace

double ceiling_shrink_fraction(const Examination& x, bool any_named, const EnergyGap& gap) {
  if (gap.before_J <= 0) return 0.0;
  const Identification& id = x.id;
  const std::vector<int> columns = flexible_columns(x, any_named);
  const Equations equations = ridged(id, columns);
  const DictionaryLayout layout = lay_out(id.signals, x.dataset.robot);
  const std::vector<RunSignals> signals = read_signals(x.runs.validation, channel_delay_s(id.state));
  std::vector<double> gap_J(signals.size());
  const std::size_t folds = std::max<std::size_t>(1, fold_count(x.runs));
  for (std::size_t fold = 0; fold < folds; ++fold) {
    const Eigen::VectorXd parameters =
        fit_parameters(equations, fitted_runs(x.runs, fold), columns, id.dispersion);
    const ModelPoint point = x.point_of(
        adopt(id.equations, id.nuisances, id.state, any_named ? x.best() : Explanation{}, parameters));
    parallel_for(signals.size(), [&](std::size_t r) {
      if (!x.runs.fold_of.empty() && x.runs.fold_of[r] != fold) return;
      const Prediction p = predict(signals[r], point);
      gap_J[r] = flexible_gap_J(signals[r], p,
                                dictionary_part(id, layout, parameters, signals[r], x.dataset.robot, p));
    });
  }
  double after_J = 0;
  for (double run_J : gap_J) after_J += std::abs(run_J);
  return std::clamp(1 - after_J / gap.before_J, std::max(0.0, gap.shrink_fraction), 1.0);
}

}  // namespace joulepath
