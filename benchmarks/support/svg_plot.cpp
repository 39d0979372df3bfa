#include "benchmarks/support/svg_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace joulepath::bench {
namespace {

constexpr double kLeft = 62, kTop = 34, kWidth = 520, kHeight = 300, kLegend = 190;
constexpr const char* kPalette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000"};

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string label(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>", x, y, anchor, more) + escaped(text) +
         "</text>\n";
}

/// Round tick positions that span [low, high], about six of them.
struct Axis {
  double low{}, high{}, step{};

  static Axis over(double low, double high) {
    if (!(high > low)) low -= 0.5, high = low + 1.0;
    const double raw = (high - low) / 5;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    const double unit = raw / power;
    const double step = power * (unit < 1.5 ? 1 : unit < 3.5 ? 2 : unit < 7.5 ? 5 : 10);
    return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step};
  }
  double fraction(double value) const { return (value - low) / (high - low); }
};

std::string series_text(const PlotSeries& series, const Axis& x, const Axis& y, const char* color) {
  std::string path, marks;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    const double at_x = kLeft + kWidth * x.fraction(series.x[i]);
    const double at_y = kTop + kHeight * (1 - y.fraction(series.y[i]));
    path += format("%.1f,%.1f ", at_x, at_y);
    marks += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", at_x, at_y, color);
  }
  if (series.points) return marks;
  return "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"" + std::string(color) + "\" points=\"" +
         path + "\"/>\n";
}

}  // namespace

std::string svg_text(const Plot& plot) {
  double x_low = 1e300, x_high = -1e300, y_low = plot.from_zero ? 0 : 1e300, y_high = -1e300;
  for (const PlotSeries& series : plot.series)
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      x_low = std::min(x_low, series.x[i]), x_high = std::max(x_high, series.x[i]);
      y_low = std::min(y_low, series.y[i]), y_high = std::max(y_high, series.y[i]);
    }
  const Axis x = Axis::over(x_low, x_high), y = Axis::over(y_low, y_high);
  const double bottom = kTop + kHeight, right = kLeft + kWidth;
  std::string out = format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"sans-serif\" "
      "font-size=\"12\" fill=\"#222\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
      right + kLegend, bottom + 52);
  for (double tick = x.low; tick <= x.high + x.step / 2; tick += x.step) {
    const double at = kLeft + kWidth * x.fraction(tick);
    out += format("<path d=\"M%.1f %.1fV%.1f\" stroke=\"#ddd\"/>\n", at, kTop, bottom);
    out += label(at, bottom + 17, "middle", format("%.6g", std::abs(tick) < x.step / 1e6 ? 0.0 : tick));
  }
  for (double tick = y.low; tick <= y.high + y.step / 2; tick += y.step) {
    const double at = kTop + kHeight * (1 - y.fraction(tick));
    out += format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"#ddd\"/>\n", kLeft, at, right);
    out += label(kLeft - 6, at + 4, "end", format("%.6g", std::abs(tick) < y.step / 1e6 ? 0.0 : tick));
  }
  out +=
      format("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#555\"/>\n",
             kLeft, kTop, kWidth, kHeight);
  out += label(kLeft, 20, "start", plot.title, "font-size=\"14\" font-weight=\"bold\"");
  out += label(kLeft + kWidth / 2, bottom + 40, "middle", plot.x_label);
  out += label(16, kTop + kHeight / 2, "middle", plot.y_label,
               format("transform=\"rotate(-90 16 %.1f)\"", kTop + kHeight / 2).c_str());
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    const char* color = kPalette[(series.color < 0 ? i : static_cast<std::size_t>(series.color)) % 7];
    const double at = kTop + 10 + 18 * static_cast<double>(i);
    out += series_text(series, x, y, color);
    out +=
        series.points
            ? format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", right + 22, at, color)
            : format("<path d=\"M%.1f %.1fh20\" stroke-width=\"2\" stroke=\"%s\"/>\n", right + 12, at, color);
    out += label(right + 38, at + 4, "start", series.name);
  }
  return out + "</svg>\n";
}

void write_svg(const Plot& plot, const std::string& file) {
  std::ofstream out(file);
  out << svg_text(plot);
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace joulepath::bench
