#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace joulepath::nlp {

/// Quadratic model of one segment by the steps of (u0, a0, u1, a1, dt), with two linear equalities.
struct Stage {
  static constexpr std::size_t kLocal = 5, kEqualities = 2;
  std::array<std::array<double, kLocal>, kLocal> hessian{};
  std::array<double, kLocal> gradient{};
  std::array<double, kLocal> border{};  ///< gradient of the row that borders the system
  std::array<std::array<double, kLocal>, kEqualities> equality{};
  std::array<double, kEqualities> wanted{};  ///< targets of the equalities' steps
};

/// Minimizes the sum of the stages' quadratics over the steps of all nodes and segments, both ends fixed:
/// dynamic programming from the last segment to the first. A segment's unknowns (u1, a1, dt) are eliminated
/// through its equalities and through the rows that later segments impose on (u1, a1). At most one unknown is
/// free, and the minimum exists exactly if its curvature is positive in every segment. O(N).
///
/// Two right sides are solved at once, the gradient and the border: the steps are linear in the border's
/// multiplier.
class StageSystem {
 public:
  explicit StageSystem(std::size_t segments) : stages(segments), eliminations_(segments), step_(segments) {}

  std::vector<Stage> stages;

  /// False if a curvature is not positive.
  [[nodiscard]] bool solve();
  /// Steps of a segment's (u0, a0, u1, a1, dt): column 0 for the gradient, column 1 per unit of the border.
  const std::array<std::array<double, 2>, Stage::kLocal>& step(std::size_t segment) const {
    return step_[segment];
  }
  /// Multipliers of the equalities, with the border's multiplier; after solve().
  void multipliers(double border, std::vector<std::array<double, Stage::kEqualities>>& to) const;

 private:
  static constexpr std::size_t kNode = 2, kOwn = 3;  ///< unknowns of a node; (u1, a1, dt)
  static constexpr std::size_t kMostRows = Stage::kEqualities + kNode;

  /// The remainder of the segments after a node: a quadratic in its step, and rows on it.
  struct Remainder {
    double hessian[kNode][kNode]{};
    double gradient[kNode][2]{};
    std::size_t rows{};
    double row[kNode][kNode]{};
    double right[kNode][2]{};
  };
  /// A segment's quadratic, later segments included.
  struct Combined {
    double hessian[Stage::kLocal][Stage::kLocal]{};
    double gradient[Stage::kLocal][2]{};
  };
  /// The step of a segment as a function of the step x of the node before it.
  struct Elimination {
    std::size_t rows{};
    std::array<int, kMostRows> column{};         ///< which of (u1, a1, dt) a row determines; -1: none
    double transform[kMostRows][kMostRows]{};    ///< reduced rows by the rows given
    double tangent[Stage::kLocal][kNode + 1]{};  ///< of the local step by x and the free unknown
    double offset[Stage::kLocal][2]{};
    bool free{};
    double gain[kNode]{}, constant[2]{};    ///< free unknown by x
    double hessian[kOwn][Stage::kLocal]{};  ///< rows of (u1, a1, dt), later segments included
    double gradient[kOwn][2]{};
  };
  static void combine(const Stage& stage, const Remainder& behind, Combined& all);
  static void solve_rows(const Stage& stage, const Remainder& behind, Elimination& e, Remainder& before);
  [[nodiscard]] static bool minimize(const Combined& all, Elimination& e, Remainder& before);
  void expand();

  std::vector<Elimination> eliminations_{};
  std::vector<std::array<std::array<double, 2>, Stage::kLocal>> step_{};
};

}  // namespace joulepath::nlp
