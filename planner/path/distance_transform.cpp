#include "planner/path/distance_transform.hpp"

#include <algorithm>
#include <limits>

namespace joulepath {
namespace {

/// Scratch of one line; allocated once per transform.
struct Line {
  explicit Line(std::size_t n) : value(n), vertex(n), boundary(n + 1) {}
  std::vector<float> value;
  std::vector<int> vertex;
  std::vector<double> boundary;
};

/// min over q of (p - q)^2 + value(q) for all p; true if any value is finite.
bool lower_envelope(Line& line, int n, float* out, std::size_t stride) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  int last = -1;
  for (int q = 0; q < n; ++q) {
    const float height = line.value[static_cast<std::size_t>(q)];
    if (height >= kNoneMarked) continue;
    double from = -kInfinity;
    while (last >= 0) {
      const int v = line.vertex[static_cast<std::size_t>(last)];
      const double rise =
          (static_cast<double>(height) + static_cast<double>(q) * q) -
          (static_cast<double>(line.value[static_cast<std::size_t>(v)]) + static_cast<double>(v) * v);
      from = rise / (2.0 * (q - v));
      if (from > line.boundary[static_cast<std::size_t>(last)]) break;
      --last;
      from = -kInfinity;
    }
    ++last;
    line.vertex[static_cast<std::size_t>(last)] = q;
    line.boundary[static_cast<std::size_t>(last)] = from;
  }
  if (last < 0) return false;
  line.boundary[static_cast<std::size_t>(last) + 1] = kInfinity;
  std::size_t k = 0;
  for (int p = 0; p < n; ++p) {
    while (line.boundary[k + 1] < p) ++k;
    const double step = p - line.vertex[k];
    out[static_cast<std::size_t>(p) * stride] = static_cast<float>(
        step * step + static_cast<double>(line.value[static_cast<std::size_t>(line.vertex[k])]));
  }
  return true;
}

}  // namespace

std::vector<float> squared_distance_transform(const std::vector<std::uint8_t>& marked, int width,
                                              int height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<float> distance(columns * rows, kNoneMarked);
  // Down the columns the values are 0 or infinite: two sweeps count the cells to the nearest mark.
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * columns + column;
      if (marked[i] != 0) {
        distance[i] = 0;
      } else if (row > 0 && distance[i - columns] < kNoneMarked) {
        distance[i] = distance[i - columns] + 1;
      }
    }
  for (std::size_t row = rows - 1; row-- > 0;)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * columns + column;
      distance[i] = std::min(distance[i], distance[i + columns] + 1);
    }
  Line line(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    float* values = distance.data() + row * columns;
    for (std::size_t column = 0; column < columns; ++column)
      line.value[column] = values[column] >= kNoneMarked ? kNoneMarked : values[column] * values[column];
    lower_envelope(line, width, values, 1);
  }
  return distance;
}

}  // namespace joulepath
