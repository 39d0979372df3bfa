#include "planner/nlp/fast/fast_model.hpp"

#include <algorithm>

namespace joulepath::nlp {

void FastModel::reserve(std::size_t segments, std::size_t rows) {
  jets_.reserve(segments);
  coefficients_.reserve(segments);
  rows_.reserve(rows);
  constant_.reserve(rows);
}

void FastModel::set_problem(const Problem& problem) {
  p_ = &problem;
  jets_.resize(problem.segment_count());
  rows_.resize(problem.rows.size());
  constant_.resize(problem.rows.size());
  rows_known_ = false;
  coefficients_.clear();
  coefficients_.reserve(problem.segment_count());
  for (std::size_t k = 0; k < problem.segment_count(); ++k) {
    const Segment& segment = problem.segments[k];
    Coefficients c{.ds = segment.ds,
                   .affine = is_affine(segment),
                   .bus = segment.plant->robot.power.sharing == PowerSharing::bus,
                   .power = affine_power(segment)};
    const auto first = problem.rows.begin() + static_cast<std::ptrdiff_t>(problem.first_row[k]);
    const auto last = problem.rows.begin() + static_cast<std::ptrdiff_t>(problem.first_row[k + 1]);
    c.linear_rows =
        std::all_of(first, last, [](const ActiveRow& row) { return row.term <= kLastLinearTerm; });
    coefficients_.push_back(c);
  }
}

void FastModel::evaluate(const std::vector<double>& b) {
  objective_ = duration_s_ = 0;
  NodeRate before(b.front());
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    const Coefficients& c = coefficients_[k];
    const NodeRate behind(b[k + 1]);
    jets_[k] = c.affine ? affine_segment_jets(c.ds, c.power, c.bus, before, behind)
                        : segment_jets(p_->segments[k], b[k], b[k + 1]);
    objective_ += p_->energy_weight * (jets_[k].energy_J[0].value + jets_[k].energy_J[1].value) +
                  p_->time_weight_W * jets_[k].duration_s.value;
    duration_s_ += jets_[k].duration_s.value;
    evaluate_rows(k, b[k], b[k + 1]);
    before = behind;
  }
  rows_known_ = true;
}

void FastModel::evaluate_rows(std::size_t k, double b0, double b1) {
  const std::size_t first = p_->first_row[k], last = p_->first_row[k + 1];
  if (first == last) return;
  if (rows_known_ && coefficients_[k].linear_rows) {
    for (std::size_t i = first; i < last; ++i)
      rows_[i].value = rows_[i].d[0] * b0 + rows_[i].d[1] * b1 + constant_[i];
    return;
  }
  const Interval<Jet> interval = jet_interval(p_->segments[k], b0, b1);
  for (std::size_t i = first; i < last; ++i) {
    rows_[i] = evaluate_row(*p_, p_->rows[i], interval);
    constant_[i] = rows_[i].value - rows_[i].d[0] * b0 - rows_[i].d[1] * b1;
  }
}

}  // namespace joulepath::nlp
