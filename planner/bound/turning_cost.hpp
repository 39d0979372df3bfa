#pragma once

#include <Eigen/Core>
#include <vector>

namespace joulepath {

/// The convex function f(d) = max over j of c_j + q_j d of the turn d (rad) on a stage.
class TurningCost {
 public:
  struct Line {
    double price{}, constant{};  ///< q, c
    double operator()(double turn_rad) const { return constant + price * turn_rad; }
  };

  /// `prices`: rising.
  TurningCost(const Eigen::ArrayXd& prices, const Eigen::ArrayXd& constants);

  double operator()(double turn_rad) const;
  /// The size of a turn beyond which the function is one line on either side.
  double bent_rad() const;
  /// That line, for turns of one sign.
  const Line& beyond(int way) const { return way > 0 ? lines_.back() : lines_.front(); }

  /// Values at the turns -reach .. reach, in cells: exact at 0, and such that no chord between neighbors lies
  /// above the function.
  std::vector<double> below_on_grid(double cell_rad, int reach) const;

 private:
  std::vector<Line> lines_{};
  std::vector<double> bends_{};  ///< between the lines
};

}  // namespace joulepath
