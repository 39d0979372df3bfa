#pragma once

#include <array>
#include <map>
#include <vector>

#include "planner/bound/heading_stages.hpp"
#include "planner/bound/turning_cost.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

// Design: docs/nlp.md, "What the bound over all paths means"
namespace joulepath {

/// A dynamic program over headings from a given one, along the stages of a way: a lower bound, at every
/// heading, of the cost less a multiplier lambda (J/m) times the place reached. Headings lie on a circle of
/// two turns, so that a left and a right turn to one heading end apart.
class HeadingProgram {
 public:
  /// `reverse`: every stage may be driven backward.
  HeadingProgram(std::vector<HeadingStage> stages, double anchor_rad, bool reverse);

  /// False where the multiplier is too large for the stages: there is no bound then.
  [[nodiscard]] bool run(const Point2& lambda);

  /// Cost (J) at a heading relative to the given one, and the least one over all headings.
  double cost_J(double turned_rad) const;
  double least_cost_J() const;
  double cheapest_rad() const;
  /// The place that the cheapest motion to a heading reaches: a supergradient of the cost.
  Point2 reached_m(double turned_rad) const;

 private:
  static constexpr int kHeadings = 180;
  static constexpr int kLevels = 8;  ///< of the multiplier along the motion, and of its slope
  using Costs = std::array<double, kHeadings>;
  using OnGrid = std::vector<double>;

  void make_whole_costs(const HeadingStage& stage);
  void make_optional_costs(const HeadingStage& stage);
  void drive(std::size_t k);
  void choose(std::size_t k);
  void turn_further(const Costs& before);
  std::size_t merged(int least_level, int greatest_level);
  int& from(std::size_t k, int heading);

  std::vector<HeadingStage> stages_{};
  double anchor_rad_{};
  bool reverse_{};
  double size_{}, course_{};  ///< of lambda: J/m, rad
  Costs along_{};             ///< lambda along the motion
  std::array<bool, kHeadings> forward_{};
  Costs cost_{};
  std::vector<int> from_{};
  // Of the present stage:
  int reach_{};  ///< cells
  std::vector<TurningCost::Line> beyond_{};
  std::vector<OnGrid> by_level_{};
  std::map<std::pair<int, int>, std::size_t> merged_{};
  std::vector<OnGrid> on_grid_{};
  std::array<std::size_t, 2 * kHeadings> choice_{};  ///< whole stages: of `on_grid_`, by the mean heading
  Costs most_along_{};                               ///< optional stages
};

}  // namespace joulepath
