#pragma once

#include <optional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/shape/free_spline.hpp"
#include "planner/path/shape/spline_slopes.hpp"

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {

inline constexpr double kClearanceMargin_m = 0.002;

/// One inequality `value` <= 0 and its derivatives; these are absent where it is constant.
struct ConstraintRow {
  double value{};
  std::size_t spline{};
  std::optional<PointSlope> slope{};
};

/// The inequalities of splines that a search moves. Per part of their paths: the margin less the least slack
/// on it, in metres. Per span: its bend.
class SplineConstraints {
 public:
  /// `first`: the paths with which the search begins; their lengths determine the parts.
  SplineConstraints(const FootprintChecker& checker, const std::vector<Path>& first);

  std::size_t rows() const { return parts_.size() + spans_; }
  std::vector<ConstraintRow> at(const std::vector<FreeSpline>& splines, const std::vector<Path>& paths,
                                bool with_slopes) const;

 private:
  /// A part of a span that has a constraint of its own.
  struct Part {
    std::size_t spline{}, span{};
    double from{}, to{};  ///< shares of the span's length
  };
  struct Nearest {
    double slack_m{}, s_m{};
  };
  Nearest nearest_on(const Part& part, const Curve& curve) const;
  PointSlope margin_slope(const Part& part, const Curve& curve, double s_m) const;

  const FootprintChecker& checker_;
  std::vector<Part> parts_{};
  std::size_t spans_{};  ///< of all splines
};

}  // namespace joulepath
