#include "planner/path/floor/distance_transform.hpp"

#include <algorithm>
#include <limits>

namespace joulepath {
namespace {

/// The lower envelope of parabolas (x - position)^2 + height, built from left to right.
class Envelope {
 public:
  explicit Envelope(std::size_t most) { parabolas_.reserve(most); }
  void clear() { parabolas_.clear(); }
  bool empty() const { return parabolas_.empty(); }

  void add(double position, double height) {
    double from = -std::numeric_limits<double>::infinity();
    while (!parabolas_.empty()) {
      const Parabola& last = parabolas_.back();
      const double rise = (height + position * position) - (last.height + last.position * last.position);
      from = rise / (2 * (position - last.position));
      if (from > last.from) break;
      parabolas_.pop_back();
      from = -std::numeric_limits<double>::infinity();
    }
    parabolas_.push_back({position, height, from});
  }
  /// Value at x; calls must be in ascending order of x, `k` starts at 0.
  double value(double x, std::size_t& k) const {
    while (k + 1 < parabolas_.size() && parabolas_[k + 1].from < x) ++k;
    const double step = x - parabolas_[k].position;
    return step * step + parabolas_[k].height;
  }

 private:
  struct Parabola {
    double position{}, height{}, from{};  ///< lowest from x = from on
  };
  std::vector<Parabola> parabolas_{};
};

/// Cells from each cell to the nearest mark in its column.
void column_distances(const std::vector<std::uint8_t>& marked, std::size_t columns, std::size_t rows,
                      std::vector<float>& distance) {
  for (std::size_t i = 0; i < columns * rows; ++i) {
    if (marked[i] != 0) {
      distance[i] = 0;
    } else if (i >= columns && distance[i - columns] < kNoneMarked) {
      distance[i] = distance[i - columns] + 1;
    }
  }
  for (std::size_t i = columns * (rows - 1); i-- > 0;)
    distance[i] = std::min(distance[i], distance[i + columns] + 1);
}

}  // namespace

std::vector<float> squared_distance_transform(const std::vector<std::uint8_t>& marked, int width,
                                              int height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<float> distance(columns * rows, kNoneMarked);
  column_distances(marked, columns, rows, distance);
  Envelope envelope(columns + 1);
  std::vector<double> height_of(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    float* values = distance.data() + row * columns;
    for (std::size_t c = 0; c < columns; ++c) {
      const double gap =
          std::max(0.0, static_cast<double>(values[c]) - 0.5);  // to the near side of the square
      height_of[c] = values[c] >= kNoneMarked ? kNoneMarked : gap * gap;
    }
    envelope.clear();
    for (std::size_t side = 0; side <= columns;
         ++side) {  // sides of squares lie between the columns' centers
      const double left = side > 0 ? height_of[side - 1] : kNoneMarked;
      const double lowest = std::min(left, side < columns ? height_of[side] : kNoneMarked);
      if (lowest < kNoneMarked) envelope.add(static_cast<double>(side) - 0.5, lowest);
    }
    if (envelope.empty()) continue;
    std::size_t k = 0;
    for (std::size_t c = 0; c < columns; ++c)
      values[c] = static_cast<float>(std::min(height_of[c], envelope.value(static_cast<double>(c), k)));
  }
  return distance;
}

}  // namespace joulepath
