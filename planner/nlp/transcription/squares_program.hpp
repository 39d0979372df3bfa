#pragma once

#include "planner/nlp/transcription/segment_jets.hpp"
#include "planner/nlp/transcription/segment_program.hpp"

namespace joulepath::nlp {

/// A Problem in its own unknowns: squares of the rate at the inner nodes.
class SquaresProgram {
 public:
  static constexpr std::size_t kLocal = 2;
  static constexpr std::size_t kParts = 1;

  SquaresProgram(const Problem& problem, const std::vector<double>& b_guess) : p_(problem), guess_(b_guess) {}

  const Problem& problem() const { return p_; }
  std::size_t unknown_count() const { return p_.unknown_count(); }
  double start(std::size_t i) const { return guess_[i + 1]; }
  Bounds unknown_bounds(std::size_t i) const { return {0.0, p_.cap[i + 1].squared}; }

  std::size_t row_count(std::size_t k) const { return p_.first_row[k + 1] - p_.first_row[k]; }
  Bounds row_bounds(std::size_t k, std::size_t i) const { return p_.rows[p_.first_row[k] + i].bounds; }

  Columns<kLocal> columns(std::size_t k) const {
    const auto node = [&](std::size_t at) {
      return at == 0 || at + 1 == p_.node_count() ? kFixed : static_cast<int>(at - 1);
    };
    return {node(k), node(k + 1)};
  }

  void evaluate(const double* x, std::size_t k, SegmentValues<kLocal>& values) const {
    const double b0 = k == 0 ? p_.b_start : x[k - 1], b1 = k + 1 == p_.segment_count() ? p_.b_end : x[k];
    const SegmentJets jets = segment_jets(p_.segments[k], b0, b1);
    values.energy_J.assign(jets.energy_J.begin(), jets.energy_J.end());
    values.duration_s = jets.duration_s;
    values.rows.resize(row_count(k));
    if (values.rows.empty()) return;
    const Interval<Jet> interval = jet_interval(p_.segments[k], b0, b1);
    for (std::size_t i = 0; i < values.rows.size(); ++i)
      values.rows[i] = evaluate_row(p_, p_.rows[p_.first_row[k] + i], interval);
  }

 private:
  const Problem& p_;
  const std::vector<double>& guess_;
};

}  // namespace joulepath::nlp
