#pragma once

#include <functional>
#include <optional>

#include "planner/path/shape/spline_slopes.hpp"
#include "planner/profile/draft_series.hpp"
#include "planner/ways/way_score.hpp"

namespace joulepath {

/// The cost of driving a leg along a curve at the leg's price of a second, and its derivatives.
class LegDrafts {
 public:
  /// `turning_J`: cost after the arrival in a heading; absent: none.
  LegDrafts(const ChoiceContext& context, std::size_t leg_index,
            std::function<double(double arrives_rad)> turning_J = {});

  /// Infinite where the path cannot be driven.
  double cost_J(const Path& path);
  /// Derivatives of the last cost, which was finite and that of this spline.
  [[nodiscard]] SplineSlopes slopes(const FreeSpline& spline) const;
  /// Begins a new series: the next path may be a different one.
  void restart() { series_.emplace(); }

 private:
  const ChoiceContext& context_;
  std::size_t leg_index_;
  std::function<double(double)> turning_J_;
  std::optional<DraftSeries> series_{};
  Path path_{};
};

}  // namespace joulepath
