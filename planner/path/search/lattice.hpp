#pragma once

#include <vector>

#include "planner/path/floor/free_space.hpp"

namespace joulepath {

/// A coarse square lattice over the floor with eight neighbors and a price per metre at each node, for quick
/// searches that avoid earlier ways. A node whose place is not clear moves to the place nearby that has most
/// room, so that few passages narrower than the spacing are missed.
class Lattice {
 public:
  explicit Lattice(const FreeSpace& space, double spacing_m = 0.2);

  /// The cheapest way over nodes whose connections are free (A*); empty when there is none.
  [[nodiscard]] std::vector<Point2> route(const Point2& start_m, const Point2& goal_m,
                                          const DiscLineCheck& free) const;
  /// Increases the price within a corridor about a polyline, except near its ends.
  void make_dear(const std::vector<Point2>& line_m, double corridor_m, double except_near_ends_m,
                 double extra_price);

 private:
  struct Node {
    int column{}, row{};
  };
  std::size_t index(Node node) const {
    return static_cast<std::size_t>(node.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(node.column);
  }
  Node node(std::size_t i) const {
    return {static_cast<int>(i % static_cast<std::size_t>(columns_)),
            static_cast<int>(i / static_cast<std::size_t>(columns_))};
  }
  const Point2& place(Node node) const { return places_[index(node)]; }
  /// Calls visit(node) for a node and its neighbors.
  template <class Visit>
  void for_nodes_around(Node center, const Visit& visit) const;
  Node nearest(const Point2& point_m) const;

  double spacing_m_{};
  ObstacleField::Extent extent_{};
  int columns_{}, rows_{};
  std::vector<Point2> places_{};
  std::vector<double> price_{};
};

}  // namespace joulepath
