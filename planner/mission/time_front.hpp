#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

namespace joulepath {

/// Least cost over a time: convex, falling and linear between points, from the soonest to the cheapest; later
/// costs the same as the cheapest.
class TimeFront {
 public:
  struct Point {
    double time_s{};
    double cost_J{};
  };

  TimeFront(std::initializer_list<Point> points) : points_(points) {}
  /// The greatest front below some points.
  [[nodiscard]] static TimeFront below(std::vector<Point> points);

  [[nodiscard]] double soonest_s() const { return points_.front().time_s; }
  [[nodiscard]] double least_J() const { return points_.back().cost_J; }
  [[nodiscard]] double cheapest_s() const { return points_.back().time_s; }
  /// The least cost at a time; infinite before the soonest.
  [[nodiscard]] double at(double time_s) const;

  /// The front of two drives, one after the other: each second goes to the drive in which it saves more.
  friend TimeFront operator+(const TimeFront& first, const TimeFront& second);
  /// Earlier arrivals wait until a time.
  void wait_until(double time_s, double waiting_W);
  /// Removes times after this one; the soonest stays.
  void end_at(double time_s);
  void shift(double time_s, double cost_J);

  /// Whether it is at most the other at every time.
  [[nodiscard]] bool is_below(const TimeFront& other) const;

 private:
  std::vector<Point> points_{};
};

}  // namespace joulepath
