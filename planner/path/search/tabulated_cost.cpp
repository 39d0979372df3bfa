#include "planner/path/search/tabulated_cost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace joulepath {
namespace {
constexpr double kCell_m = 0.25;
constexpr int kHeadings = 16;
}  // namespace

TabulatedCost::TabulatedCost(const TravelCost& exact, const ObstacleField::Extent& extent)
    : exact_(exact), extent_(extent) {
  if (!exact.rate) return;
  columns_ = static_cast<int>((extent.x_max_m - extent.x_min_m) / kCell_m) + 1;
  rows_ = static_cast<int>((extent.y_max_m - extent.y_min_m) / kCell_m) + 1;
  rates_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) * kHeadings, -1.0F);
}

TravelCost TabulatedCost::cost() {
  if (!exact_.rate) return exact_;
  return {[this](double x_m, double y_m, double heading_rad) { return rate(x_m, y_m, heading_rad); },
          exact_.least_rate};
}

double TabulatedCost::rate(double x_m, double y_m, double heading_rad) {
  const int column = std::clamp(static_cast<int>((x_m - extent_.x_min_m) / kCell_m), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>((y_m - extent_.y_min_m) / kCell_m), 0, rows_ - 1);
  constexpr double kPerHeading = kHeadings / (2 * std::numbers::pi);
  const int heading =
      static_cast<int>(std::lround(heading_rad * kPerHeading) % kHeadings + kHeadings) % kHeadings;
  float& entry = rates_[(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                         static_cast<std::size_t>(column)) *
                            kHeadings +
                        static_cast<std::size_t>(heading)];
  if (entry < 0)
    entry = static_cast<float>(exact_.rate(extent_.x_min_m + (column + 0.5) * kCell_m,
                                           extent_.y_min_m + (row + 0.5) * kCell_m, heading / kPerHeading));
  return static_cast<double>(entry);
}

}  // namespace joulepath
