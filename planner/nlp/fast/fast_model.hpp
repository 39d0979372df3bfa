#pragma once

#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/segment_jets.hpp"

namespace joulepath::nlp {

/// A Problem's functions at one point, with derivatives, laid out for many evaluations: the coefficients of
/// affine segments are stored together (a Segment has some kilobytes, of which an iteration needs 300 bytes),
/// and rows that are linear in b keep their derivatives.
class FastModel {
 public:
  /// Room for problems of this size.
  void reserve(std::size_t segments, std::size_t rows);
  /// Takes another problem, which has to outlive its use.
  void set_problem(const Problem& problem);

  const Problem& problem() const { return *p_; }
  /// Evaluates at squares of the rate at all nodes.
  void evaluate(const std::vector<double>& b);

  const SegmentJets& jets(std::size_t segment) const { return jets_[segment]; }
  const Jet& row(std::size_t i) const { return rows_[i]; }
  double objective() const { return objective_; }  ///< without recovery
  double duration_s() const { return duration_s_; }

 private:
  struct Coefficients {
    double ds{};
    bool affine{}, bus{};
    bool linear_rows{};  ///< all of the segment's
    std::array<Sided<AffinePower>, kEnergyPoints> power{};
  };
  void evaluate_rows(std::size_t segment, double b0, double b1);

  const Problem* p_{};
  std::vector<Coefficients> coefficients_{};
  std::vector<SegmentJets> jets_{};
  std::vector<Jet> rows_{};
  std::vector<double> constant_{};  ///< of linear rows
  bool rows_known_{};
  double objective_{}, duration_s_{};
};

}  // namespace joulepath::nlp
