#include "extensions/studies/sweep/sweep_analysis.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <numeric>

#include "extensions/studies/sweep/design_table.hpp"

namespace joulepath {
namespace {

using Labels = std::vector<const LevelColumn*>;

bool read_number(const std::string& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// A label for a number: five digits; a word stays unchanged.
std::string short_text(const std::string& text) {
  double value{};
  if (!read_number(text, value)) return text;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.5g", value);
  return digits;
}

/// Residual sum of squares of a model with one term per column: normal equations of indicator variables. The
/// pseudo-inverse removes the part that the indicators of one column share with the constant.
double residual(const Labels& columns, const std::vector<double>& values) {
  std::vector<Eigen::Index> first{1};
  for (const LevelColumn* column : columns)
    first.push_back(first.back() + static_cast<Eigen::Index>(column->labels.size()));
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(first.back(), first.back());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(first.back());
  std::vector<Eigen::Index> ones(columns.size() + 1, 0);
  double square = 0.0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      ones[c + 1] = first[c] + static_cast<Eigen::Index>(columns[c]->level[row]);
    for (const Eigen::Index i : ones) {
      right[i] += values[row];
      for (const Eigen::Index j : ones) normal(i, j) += 1.0;
    }
    square += values[row] * values[row];
  }
  const Eigen::VectorXd fit = normal.completeOrthogonalDecomposition().solve(right);
  return std::max(0.0, square - fit.dot(right));
}

/// The combined levels of two columns.
LevelColumn pair_of(const LevelColumn& a, const LevelColumn& b) {
  LevelColumn pair{
      .name = {}, .labels = std::vector<std::string>(a.labels.size() * b.labels.size()), .level = {}};
  for (std::size_t row = 0; row < a.level.size(); ++row)
    pair.level.push_back(a.level[row] * b.labels.size() + b.level[row]);
  return pair;
}

std::vector<LevelMean> means_of(const LevelColumn& column, const std::vector<double>& values) {
  std::vector<LevelMean> means(column.labels.size());
  for (std::size_t row = 0; row < values.size(); ++row) {
    means[column.level[row]].mean += values[row];
    ++means[column.level[row]].rows;
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i].label = column.labels[i];
    if (means[i].rows > 0) means[i].mean /= static_cast<double>(means[i].rows);
  }
  std::erase_if(means, [](const LevelMean& level) { return level.rows == 0; });
  return means;
}

}  // namespace

LevelColumn levels_of(const std::string& name, const std::vector<std::string>& values, std::size_t most,
                      std::size_t parts) {
  std::vector<double> numbers(values.size());
  bool numeric = true;
  for (std::size_t i = 0; i < values.size(); ++i) numeric = numeric && read_number(values[i], numbers[i]);
  LevelColumn column{.name = name, .labels = {}, .level = {}};
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  if (numeric)
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  std::map<std::string, std::size_t> known;
  for (const std::size_t row : order)
    if (known.emplace(values[row], known.size()).second) column.labels.push_back(values[row]);
  column.level.resize(values.size());
  if (!numeric || column.labels.size() <= most) {
    for (std::size_t row = 0; row < values.size(); ++row) column.level[row] = known.at(values[row]);
    for (std::string& label : column.labels) label = short_text(label);
    return column;
  }
  column.labels.clear();
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * order.size() / parts, end = (part + 1) * order.size() / parts;
    for (std::size_t i = begin; i < end; ++i) column.level[order[i]] = part;
    column.labels.push_back(short_text(values[order[begin]]) + " to " + short_text(values[order[end - 1]]));
  }
  return column;
}

std::vector<LevelColumn> level_columns(const std::vector<std::string>& names,
                                       const std::vector<std::vector<std::string>>& values) {
  std::vector<LevelColumn> columns;
  std::size_t terms = 1;
  for (std::size_t p = 0; p < names.size(); ++p) {
    columns.push_back(levels_of(names[p], values[p]));
    if (!columns.back().labels.empty()) terms += columns.back().labels.size() - 1;
  }
  const std::size_t rows = values.empty() ? 0 : values.front().size();
  if (names.size() < 2 || rows == 0 || terms < rows) return columns;
  const std::size_t parts = std::clamp<std::size_t>(rows / (2 * names.size()), 2, 5);
  for (std::size_t p = 0; p < names.size(); ++p) columns[p] = levels_of(names[p], values[p], parts, parts);
  return columns;
}

SweepEffects sweep_effects(const std::vector<LevelColumn>& columns, const std::vector<double>& raw) {
  SweepEffects effects;
  // Centered values: otherwise the sums of squares are differences of nearly equal numbers.
  const double mean =
      raw.empty() ? 0.0 : std::accumulate(raw.begin(), raw.end(), 0.0) / static_cast<double>(raw.size());
  std::vector<double> values = raw;
  double total = 0.0;
  for (double& value : values) {
    value -= mean;
    total += value * value;
  }
  const double scale = total > 0.0 ? 1.0 / total : 0.0;
  Labels all;
  for (const LevelColumn& column : columns) all.push_back(&column);
  const double additive = residual(all, values);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    Labels others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
    effects.main.push_back({.parameter = columns[c].name,
                            .levels = means_of(columns[c], raw),
                            .share_of_variance = scale * std::max(0.0, residual(others, values) - additive)});
  }
  double explained = 0.0;
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = a + 1; b < columns.size(); ++b) {
      const LevelColumn pair = pair_of(columns[a], columns[b]);
      Labels with = all;
      with.push_back(&pair);
      const double share = scale * std::max(0.0, additive - residual(with, values));
      effects.interactions.push_back({columns[a].name, columns[b].name, share});
      explained += share;
    }
  std::ranges::stable_sort(effects.interactions, std::greater{}, &Interaction::share_of_variance);
  effects.unexplained = std::max(0.0, scale * additive - explained);
  return effects;
}

std::vector<std::size_t> pareto_front(const std::vector<std::vector<double>>& rows) {
  std::vector<std::size_t> order(rows.size()), front;
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return rows[a] < rows[b]; });
  const auto beats = [&](std::size_t a, std::size_t b) {
    bool better = false;
    for (std::size_t i = 0; i < rows[a].size(); ++i) {
      if (rows[a][i] > rows[b][i]) return false;
      better = better || rows[a][i] < rows[b][i];
    }
    return better;
  };
  for (const std::size_t row : order)  // in lexical order, so that no later row beats an earlier one
    if (std::ranges::none_of(front, [&](std::size_t kept) { return beats(kept, row); })) front.push_back(row);
  std::ranges::sort(front);
  return front;
}

}  // namespace joulepath
