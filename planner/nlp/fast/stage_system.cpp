#include "planner/nlp/fast/stage_system.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

constexpr std::size_t kEqualities = Stage::kEqualities, kNode = 2, kOwn = 3;

/// Rows of a segment's constraints: coefficients of (x0 | u1, a1, dt), right sides, and the transform.
struct SegmentRows {
  std::size_t count{};
  double coefficient[kEqualities + kNode][Stage::kLocal]{};
  double right[kEqualities + kNode][2]{};
  double transform[kEqualities + kNode][kEqualities + kNode]{};

  void add(std::size_t to, std::size_t from, double factor) {
    for (std::size_t j = 0; j < Stage::kLocal; ++j) coefficient[to][j] += factor * coefficient[from][j];
    for (std::size_t j = 0; j < 2; ++j) right[to][j] += factor * right[from][j];
    for (std::size_t j = 0; j < count; ++j) transform[to][j] += factor * transform[from][j];
  }
  void scale(std::size_t row, double factor) {
    for (double& c : coefficient[row]) c *= factor;
    for (double& r : right[row]) r *= factor;
    for (double& t : transform[row]) t *= factor;
  }

  /// Gauss-Jordan with the largest pivots among the columns of (u1, a1, dt): the column of each row, or -1.
  std::array<int, kEqualities + kNode> reduce() {
    std::array<int, kEqualities + kNode> column;
    column.fill(-1);
    bool taken[kOwn] = {};
    for (std::size_t round = 0; round < std::min(count, kOwn); ++round) {
      std::size_t row = 0, at = 0;
      double most = -1;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < kOwn; ++c)
          if (column[i] < 0 && !taken[c] && std::abs(coefficient[i][kNode + c]) > most)
            most = std::abs(coefficient[i][kNode + c]), row = i, at = c;
      column[row] = static_cast<int>(at);
      taken[at] = true;
      scale(row, 1 / coefficient[row][kNode + at]);
      for (std::size_t i = 0; i < count; ++i)
        if (i != row) add(i, row, -coefficient[i][kNode + at]);
    }
    return column;
  }
};

}  // namespace

void StageSystem::combine(const Stage& stage, const Remainder& behind, Combined& all) {
  for (std::size_t i = 0; i < Stage::kLocal; ++i) {
    std::copy(stage.hessian[i].begin(), stage.hessian[i].end(), all.hessian[i]);
    all.gradient[i][0] = stage.gradient[i];
    all.gradient[i][1] = stage.border[i];
  }
  for (std::size_t i = 0; i < kNode; ++i)
    for (std::size_t j = 0; j < kNode; ++j) {
      all.hessian[kNode + i][kNode + j] += behind.hessian[i][j];
      all.gradient[kNode + i][j] += behind.gradient[i][j];
    }
}

/// Solves the rows for (u1, a1, dt) as far as possible; the rest becomes rows of the previous node.
void StageSystem::solve_rows(const Stage& stage, const Remainder& behind, Elimination& e, Remainder& before) {
  SegmentRows rows{.count = kEqualities + behind.rows};
  for (std::size_t i = 0; i < kEqualities; ++i) {
    std::copy(stage.equality[i].begin(), stage.equality[i].end(), rows.coefficient[i]);
    rows.right[i][0] = stage.wanted[i];
  }
  for (std::size_t i = 0; i < behind.rows; ++i) {
    std::copy(behind.row[i], behind.row[i] + kNode, rows.coefficient[kEqualities + i] + kNode);
    std::copy(behind.right[i], behind.right[i] + 2, rows.right[kEqualities + i]);
  }
  for (std::size_t i = 0; i < rows.count; ++i) rows.transform[i][i] = 1;
  e.rows = rows.count;
  e.column = rows.reduce();
  for (std::size_t i = 0; i < rows.count; ++i)
    std::copy(rows.transform[i], rows.transform[i] + rows.count, e.transform[i]);

  std::size_t free_column = Stage::kLocal;
  for (std::size_t c = 0; c < kOwn; ++c)
    if (std::find(e.column.begin(), e.column.end(), static_cast<int>(c)) == e.column.end())
      free_column = kNode + c;
  e.free = free_column < Stage::kLocal;
  for (auto& row : e.tangent) std::fill(std::begin(row), std::end(row), 0.0);
  for (auto& row : e.offset) std::fill(std::begin(row), std::end(row), 0.0);
  e.tangent[0][0] = e.tangent[1][1] = 1;
  if (e.free) e.tangent[free_column][kNode] = 1;
  before.rows = 0;
  for (std::size_t i = 0; i < rows.count; ++i) {
    if (e.column[i] < 0) {
      std::copy(rows.coefficient[i], rows.coefficient[i] + kNode, before.row[before.rows]);
      std::copy(rows.right[i], rows.right[i] + 2, before.right[before.rows]);
      ++before.rows;
      continue;
    }
    const std::size_t at = kNode + static_cast<std::size_t>(e.column[i]);
    for (std::size_t j = 0; j < kNode; ++j) e.tangent[at][j] = -rows.coefficient[i][j];
    if (e.free) e.tangent[at][kNode] = -rows.coefficient[i][free_column];
    std::copy(rows.right[i], rows.right[i] + 2, e.offset[at]);
  }
}

/// The quadratic in the node's step and the free unknown, minimized over the latter; false if it has no
/// minimum.
bool StageSystem::minimize(const Combined& all, Elimination& e, Remainder& before) {
  double along[Stage::kLocal][kNode + 1]{}, shifted[Stage::kLocal][2]{};
  for (std::size_t i = 0; i < Stage::kLocal; ++i) {
    std::copy(all.gradient[i], all.gradient[i] + 2, shifted[i]);
    for (std::size_t l = 0; l < Stage::kLocal; ++l) {
      for (std::size_t j = 0; j <= kNode; ++j) along[i][j] += all.hessian[i][l] * e.tangent[l][j];
      for (std::size_t j = 0; j < 2; ++j) shifted[i][j] += all.hessian[i][l] * e.offset[l][j];
    }
  }
  double reduced[kNode + 1][kNode + 1]{}, right[kNode + 1][2]{};
  for (std::size_t i = 0; i <= kNode; ++i)
    for (std::size_t l = 0; l < Stage::kLocal; ++l) {
      for (std::size_t j = 0; j <= kNode; ++j) reduced[i][j] += e.tangent[l][i] * along[l][j];
      for (std::size_t j = 0; j < 2; ++j) right[i][j] += e.tangent[l][i] * shifted[l][j];
    }
  const double curvature = e.free ? reduced[kNode][kNode] : 1.0;
  if (!(curvature > 0) || !std::isfinite(curvature)) return false;
  for (std::size_t j = 0; j < 2; ++j) {
    e.gain[j] = e.free ? -reduced[kNode][j] / curvature : 0.0;
    e.constant[j] = e.free ? -right[kNode][j] / curvature : 0.0;
  }
  for (std::size_t i = 0; i < kNode; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      before.hessian[i][j] = reduced[i][j] + e.gain[i] * reduced[kNode][j];
      before.gradient[i][j] = right[i][j] + e.gain[i] * right[kNode][j];
    }
  return true;
}

bool StageSystem::solve() {
  Remainder behind{.rows = kNode}, before;
  behind.row[0][0] = behind.row[1][1] = 1;  // the last node is fixed
  Combined all;
  for (std::size_t k = stages.size(); k-- > 0;) {
    Elimination& e = eliminations_[k];
    combine(stages[k], behind, all);
    for (std::size_t i = 0; i < kOwn; ++i) {
      std::copy(all.hessian[kNode + i], all.hessian[kNode + i] + Stage::kLocal, e.hessian[i]);
      std::copy(all.gradient[kNode + i], all.gradient[kNode + i] + 2, e.gradient[i]);
    }
    solve_rows(stages[k], behind, e, before);
    if (!minimize(all, e, before)) return false;
    behind = before;
  }
  expand();
  return true;
}

void StageSystem::expand() {
  double x[kNode][2] = {};  // the first node is fixed
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const Elimination& e = eliminations_[k];
    for (std::size_t j = 0; j < 2; ++j) {
      const double free = e.constant[j] + e.gain[0] * x[0][j] + e.gain[1] * x[1][j];
      for (std::size_t i = 0; i < Stage::kLocal; ++i)
        step_[k][i][j] = e.offset[i][j] + e.tangent[i][0] * x[0][j] + e.tangent[i][1] * x[1][j] +
                         e.tangent[i][kNode] * free;
    }
    for (std::size_t i = 0; i < kNode; ++i)
      for (std::size_t j = 0; j < 2; ++j) x[i][j] = step_[k][kNode + i][j];
  }
}

void StageSystem::multipliers(double border, std::vector<std::array<double, kEqualities>>& to) const {
  to.resize(stages.size());
  double asked[kNode] = {};  // multipliers of the rows that a segment passes to the previous one
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const Elimination& e = eliminations_[k];
    double reduced[kMostRows];
    for (std::size_t i = 0, left = 0; i < e.rows; ++i) {
      if (e.column[i] < 0) {
        reduced[i] = asked[left++];
        continue;
      }
      const auto c = static_cast<std::size_t>(e.column[i]);
      reduced[i] = -e.gradient[c][0] - border * e.gradient[c][1];
      for (std::size_t l = 0; l < Stage::kLocal; ++l)
        reduced[i] -= e.hessian[c][l] * (step_[k][l][0] + border * step_[k][l][1]);
    }
    for (std::size_t j = 0; j < e.rows; ++j) {
      double sum = 0;
      for (std::size_t i = 0; i < e.rows; ++i) sum += e.transform[i][j] * reduced[i];
      (j < kEqualities ? to[k][j] : asked[j - kEqualities]) = sum;
    }
  }
}

}  // namespace joulepath::nlp
