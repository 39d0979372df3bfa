#include "diagnosis/evidence/left_out_gain.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

LeftOutGain summed(const std::vector<double>& gains) {
  const auto n = static_cast<double>(gains.size());
  double sum = 0, square = 0;
  for (double gain : gains) sum += gain;
  for (double gain : gains) square += std::pow(gain - sum / n, 2);
  const double error = std::sqrt(square * n / std::max(1.0, n - 1));
  return {sum, error > 0 ? sum / error : 0.0};
}

}  // namespace

DictionaryFamilies dictionary_families(const Equations& equations) {
  DictionaryFamilies families;
  for (int k : equations.columns_of(Column::Kind::dictionary)) {
    const Column& column = equations.columns[static_cast<std::size_t>(k)];
    const DictionaryEntry& entry = equations.dictionary[static_cast<std::size_t>(column.owner)];
    families[entry.family + " (" + entry.channel + ")"].push_back(k);
  }
  return families;
}

std::map<std::string, LeftOutGain> left_out_gains(const Identification& id, const std::vector<int>& columns,
                                                  const DictionaryFamilies& families) {
  const Equations& equations = id.equations;
  const std::size_t count = equations.runs.size();
  std::vector<int> explained = equations.columns_of(Column::Kind::nuisance);
  explained.insert(explained.end(), columns.begin(), columns.end());
  std::map<std::string, std::vector<double>> gains;
  for (std::size_t fold = 0; fold < std::min(kFamilyFolds, count); ++fold) {
    std::vector<std::size_t> seen, judged;
    for (std::size_t r = 0; r < count; ++r) (r % kFamilyFolds == fold ? judged : seen).push_back(r);
    const LinearProblem problem = sum_runs(equations.runs, seen, equations.prior_sd);
    const Eigen::VectorXd without = fit_parameters(problem, explained, id.dispersion);
    for (const auto& [name, family] : families) {
      std::vector<int> more = explained;
      more.insert(more.end(), family.begin(), family.end());
      const Eigen::VectorXd with_it = fit_parameters(problem, more, id.dispersion);
      for (std::size_t r : judged)
        gains[name].push_back((run_loss(equations.runs[r], without) - run_loss(equations.runs[r], with_it)) /
                              id.dispersion);
    }
  }
  std::map<std::string, LeftOutGain> summary;
  for (const auto& [name, of_runs] : gains) summary[name] = summed(of_runs);
  return summary;
}

}  // namespace joulepath
