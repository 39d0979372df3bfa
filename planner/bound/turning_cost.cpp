#include "planner/bound/turning_cost.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {

TurningCost::TurningCost(const Eigen::ArrayXd& prices, const Eigen::ArrayXd& constants) {
  for (Eigen::Index j = 0; j < prices.size(); ++j) {
    const Line line{prices[j], constants[j]};
    const auto meet = [&](const Line& before) {
      return (before.constant - line.constant) / (line.price - before.price);
    };
    while (!bends_.empty() && meet(lines_.back()) <= bends_.back()) lines_.pop_back(), bends_.pop_back();
    if (!lines_.empty()) bends_.push_back(meet(lines_.back()));
    lines_.push_back(line);
  }
}

double TurningCost::operator()(double turn_rad) const {
  const auto line = std::upper_bound(bends_.begin(), bends_.end(), turn_rad) - bends_.begin();
  return lines_[static_cast<std::size_t>(line)](turn_rad);
}

double TurningCost::bent_rad() const {
  return bends_.empty() ? 0.0 : std::max(std::abs(bends_.front()), std::abs(bends_.back()));
}

std::vector<double> TurningCost::below_on_grid(double cell_rad, int reach) const {
  std::vector<double> values(static_cast<std::size_t>(2 * reach + 1));
  const auto value = [&](int cell) -> double& { return *(values.begin() + reach + cell); };
  value(0) = (*this)(0.0);
  for (const int way : {-1, 1})
    for (int k = 0; k < reach; ++k) {  // outward, on the highest line that stays below the function
      const double from_rad = way * k * cell_rad, from = value(way * k);
      const auto rise = [&](double turn_rad) {
        return ((*this)(turn_rad)-from) / std::abs(turn_rad - from_rad);
      };
      double least = rise(way * (k + 1) * cell_rad);
      for (const double bend : bends_)
        if (const double ahead = way * (bend - from_rad); ahead > 0 && ahead < cell_rad)
          least = std::min(least, rise(bend));
      value(way * (k + 1)) = from + cell_rad * least;
    }
  return values;
}

}  // namespace joulepath
