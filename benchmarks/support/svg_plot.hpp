#pragma once

#include <string>
#include <vector>

namespace joulepath::bench {

/// One curve or set of points of a plot.
struct PlotSeries {
  std::string name{};
  std::vector<double> x{};
  std::vector<double> y{};
  bool points{};  ///< markers instead of a line
  int color{-1};  ///< index into the palette; -1: by position
};

struct Plot {
  std::string title{};
  std::string x_label{};
  std::string y_label{};
  std::vector<PlotSeries> series{};
  bool from_zero{};  ///< the y axis begins at 0
};

/// The plot as an SVG document: axes with round ticks, a legend to the right. Non-finite values are skipped.
[[nodiscard]] std::string svg_text(const Plot& plot);

/// Writes svg_text() to a file; throws std::runtime_error when that fails.
void write_svg(const Plot& plot, const std::string& file);

}  // namespace joulepath::bench
