#include "planner/bound/heading_program.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace joulepath {
namespace {

constexpr int kCells = 180;  ///< on the circle of two turns
constexpr double kCell_rad = 4 * std::numbers::pi / kCells;
constexpr int kSkipped = -1;
constexpr double kLeastShare = 0.2;  ///< of the prices of a radian that a multiplier must leave

template <class Array>
auto& at(Array& values, int i) {
  return values[static_cast<std::size_t>(i)];
}

int around(int i, int count = kCells) { return (i + 2 * count) % count; }

void lower(std::vector<double>& values, const std::vector<double>& other) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::min(values[k], other[k]);
}

/// The cell below a heading, and the share of the next one.
std::pair<int, double> place_of(double turned_rad) {
  const double place = std::remainder(turned_rad, kCells * kCell_rad) / kCell_rad, cell = std::floor(place);
  return {around(static_cast<int>(cell)), place - cell};
}

/// By how much a multiplier along the motion may lie above its chords.
double interpolation_error(double size) { return size * kCell_rad * kCell_rad / 8; }

Eigen::ArrayXd prices_of(const HeadingStage& stage, double multiplier) {
  const double most_J = stage.most_J() - 0.5 * stage.length_m * multiplier;
  return Eigen::ArrayXd::LinSpaced(stage.nodes.front().rates.at.size(), -most_J, most_J);
}

}  // namespace

HeadingProgram::HeadingProgram(std::vector<HeadingStage> stages, double anchor_rad, bool reverse)
    : stages_(std::move(stages)), anchor_rad_(anchor_rad), reverse_(reverse) {
  static_assert(kHeadings == kCells);
  from_.assign(stages_.size() * kHeadings, 0);
}

int& HeadingProgram::from(std::size_t k, int heading) {
  return from_[k * kHeadings + static_cast<std::size_t>(heading)];
}

bool HeadingProgram::run(const Point2& lambda) {
  size_ = std::hypot(lambda[0], lambda[1]);
  course_ = std::atan2(lambda[1], lambda[0]);
  for (const HeadingStage& stage : stages_)
    if (0.5 * stage.length_m * size_ > (1 - kLeastShare) * stage.most_J()) return false;
  for (int i = 0; i < kHeadings; ++i) {
    const double along = size_ * std::cos(anchor_rad_ + kCell_rad * i - course_);
    at(forward_, i) = !reverse_ || along >= 0;
    at(along_, i) = reverse_ ? std::abs(along) : along;
    at(cost_, i) = stages_.front().most_J() * kCell_rad * std::min(i, kHeadings - i);
  }
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const bool is_new = k == 0 || stages_[k].group != stages_[k - 1].group;
    if (stages_[k].optional) {
      if (is_new) make_optional_costs(stages_[k]);
      choose(k);
    } else {
      if (is_new) make_whole_costs(stages_[k]);
      drive(k);
    }
  }
  return true;
}

/// The multiplier counts at both ends; what it changes in between acts on the price of a radian as a shift of
/// (sigma - middle) F, F being the slope of lambda.u(heading). A motion that passes headings further than
/// `beyond_rad` from both ends turns so much that it takes more than any cost here says. F lies in a band
/// around its value at the mean heading, for the ends in the neighboring cells as well.
void HeadingProgram::make_whole_costs(const HeadingStage& stage) {
  const double ds = stage.length_m, most_J = stage.most_J();
  const Eigen::ArrayXd prices = prices_of(stage, size_);
  const auto cost = [&](double least_slope, double most_slope) {
    return TurningCost(prices, prices.unaryExpr([&](double q) {
      return stage.cost_J(q, std::max(least_slope, -size_), std::min(most_slope, size_));
    }));
  };
  const TurningCost any = cost(-size_, size_);
  reach_ = std::clamp(static_cast<int>(std::ceil(any.bent_rad() / kCell_rad)), 1, kHeadings / 2 - 1);
  beyond_ = {any.beyond(-1), any.beyond(1)};
  double greatest_J = 0, steepest_J = 0;
  for (const HeadingStage::Node& node : stage.nodes) {
    greatest_J += node.weight_m * node.rates.at.maxCoeff();
    steepest_J += node.weight_m * std::min(node.rates(-most_J), node.rates(most_J));
  }
  const double beyond_rad = (greatest_J - steepest_J + 2 * size_ * ds) / (2 * most_J);
  const double band = std::min(2.0, beyond_rad + (0.5 * reach_ + 2) * kCell_rad);  // of the slope, in sizes
  by_level_.clear(), merged_.clear(), on_grid_.clear();
  for (int level = 0; level <= kLevels; ++level) {
    const double slope = 2.0 * level / kLevels - 1, half = band + 1.0 / kLevels;
    by_level_.push_back(
        cost(size_ * (slope - half), size_ * (slope + half)).below_on_grid(kCell_rad, reach_));
  }
  by_level_.push_back(any.below_on_grid(kCell_rad, reach_));
  std::array<int, 2 * kHeadings> level;
  for (int i = 0; i < 2 * kHeadings; ++i) {
    const double turned = anchor_rad_ + 0.5 * kCell_rad * i - course_;
    const double slope = -std::sin(turned) * (reverse_ && std::cos(turned) < 0 ? -1 : 1);
    const bool has_kink = reverse_ && std::abs(std::cos(turned)) <= band;
    at(level, i) = has_kink ? kLevels + 1 : static_cast<int>(std::lround((slope + 1) * kLevels / 2));
  }
  for (int i = 0; i < 2 * kHeadings; ++i) {
    const int one = at(level, around(i - 1, 2 * kHeadings)), two = at(level, i),
              three = at(level, around(i + 1, 2 * kHeadings));
    at(choice_, i) = merged(std::min({one, two, three}), std::max({one, two, three}));
  }
}

/// The lowest of the costs of some levels. Between the grid's turns three pairs of cells count, whose levels
/// differ: where each is below the cost of one level, so is what lies between them.
std::size_t HeadingProgram::merged(int least_level, int greatest_level) {
  const auto [found, is_new] = merged_.try_emplace({least_level, greatest_level}, on_grid_.size());
  if (is_new) {
    on_grid_.push_back(at(by_level_, least_level));
    for (int level = least_level + 1; level <= greatest_level; ++level)
      lower(on_grid_.back(), at(by_level_, level));
  }
  return found->second;
}

/// The part of the stage that is driven counts where its rate is below the multiplier along the motion, that
/// is the mean of both ends, each with the neighboring cells. The cost of a level is that of all higher ones.
void HeadingProgram::make_optional_costs(const HeadingStage& stage) {
  const double ds = stage.length_m;
  const Eigen::ArrayXd prices = prices_of(stage, size_);
  const Eigen::ArrayXd costs = prices.unaryExpr([&](double q) { return stage.cost_J(q, -size_, size_); });
  const auto cost = [&](int level) {
    return TurningCost(prices, (costs - ds * size_ * (2.0 * level / kLevels - 1)).min(0.0));
  };
  const TurningCost any = cost(kLevels);
  reach_ = std::clamp(static_cast<int>(std::ceil(any.bent_rad() / kCell_rad)), 1, kHeadings / 2 - 1);
  beyond_ = {any.beyond(-1), any.beyond(1)};
  on_grid_.assign(kLevels + 1, any.below_on_grid(kCell_rad, reach_));
  for (int level = kLevels; level-- > 0;) {
    at(on_grid_, level) = cost(level).below_on_grid(kCell_rad, reach_);
    lower(at(on_grid_, level), at(on_grid_, level + 1));
  }
  const double interpolation = interpolation_error(size_);
  for (int i = 0; i < kHeadings; ++i)
    at(most_along_, i) =
        interpolation + std::max({at(along_, around(i - 1)), at(along_, i), at(along_, around(i + 1))});
}

/// The whole stage.
void HeadingProgram::drive(std::size_t k) {
  const double half_m = 0.5 * stages_[k].length_m, interpolation = interpolation_error(size_);
  Costs before;
  for (int i = 0; i < kHeadings; ++i) at(before, i) = at(cost_, i) - half_m * (at(along_, i) + interpolation);
  cost_.fill(std::numeric_limits<double>::infinity());
  for (int b = 0; b < kHeadings; ++b)
    for (int d = -reach_; d <= reach_; ++d) {
      const int a = around(b - d);
      const OnGrid& turning = on_grid_[at(choice_, around(2 * b - d, 2 * kHeadings))];
      const double value = at(before, a) + at(turning, d + reach_);
      if (value < at(cost_, b)) at(cost_, b) = value, from(k, b) = a;
    }
  turn_further(before);
  for (int b = 0; b < kHeadings; ++b) at(cost_, b) -= half_m * (at(along_, b) + interpolation);
}

/// The stage or any part of it.
void HeadingProgram::choose(std::size_t k) {
  const Costs before = cost_;
  for (int b = 0; b < kHeadings; ++b) {
    from(k, b) = kSkipped;
    for (int d = -reach_; d <= reach_; ++d) {
      const int a = around(b - d);
      const double share = size_ > 0 ? 0.5 * (at(most_along_, a) + at(most_along_, b)) / size_ : 0.0;
      const double level = std::clamp(std::ceil((share + 1) * kLevels / 2), 0.0, 1.0 * kLevels);
      const double value = at(before, a) + at(at(on_grid_, static_cast<int>(level)), d + reach_);
      if (value < at(cost_, b)) at(cost_, b) = value, from(k, b) = a;
    }
  }
  turn_further(before);
}

/// Turns beyond the reach, at the cost that holds for all headings.
void HeadingProgram::turn_further(const Costs& before) {
  for (const int way : {-1, 1}) {
    const TurningCost::Line& line = at(beyond_, way > 0 ? 1 : 0);
    const double at_reach_J = line(way * kCell_rad * reach_), further_J = way * line.price * kCell_rad;
    double least_J = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2 * kHeadings; ++k) {
      const int b = around(way * k, kHeadings);
      least_J = std::min(least_J + further_J, at(before, around(b - way * reach_)) + at_reach_J);
      at(cost_, b) = std::min(at(cost_, b), least_J);
    }
  }
}

double HeadingProgram::cost_J(double turned_rad) const {
  const auto [i, share] = place_of(turned_rad);
  return std::lerp(at(cost_, i), at(cost_, around(i + 1)), share);
}

double HeadingProgram::least_cost_J() const { return *std::min_element(cost_.begin(), cost_.end()); }

double HeadingProgram::cheapest_rad() const {
  return kCell_rad * static_cast<double>(std::min_element(cost_.begin(), cost_.end()) - cost_.begin());
}

Point2 HeadingProgram::reached_m(double turned_rad) const {
  const auto [i, share] = place_of(turned_rad);
  int b = at(cost_, around(i + 1)) < at(cost_, i) ? around(i + 1) : i;
  Point2 reached{0, 0};
  for (std::size_t k = stages_.size(); k-- > 0;) {
    const int a = from_[k * kHeadings + static_cast<std::size_t>(b)];
    if (a == kSkipped) continue;
    for (const int end : {a, b}) {
      const double ds = 0.5 * stages_[k].length_m * (at(forward_, end) ? 1 : -1),
                   heading = anchor_rad_ + kCell_rad * end;
      reached[0] += ds * std::cos(heading), reached[1] += ds * std::sin(heading);
    }
    b = a;
  }
  return reached;
}

}  // namespace joulepath
