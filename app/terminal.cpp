#include "app/terminal.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

namespace joulepath {
namespace {

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

const char* code_of(Paint paint) {
  switch (paint) {
    case Paint::error:
      return "\033[1;31m";
    case Paint::warning:
      return "\033[33m";
    case Paint::good:
      return "\033[32m";
    case Paint::dim:
      return "\033[2m";
    case Paint::bold:
      return "\033[1m";
  }
  return "";
}

/// Whether the stream is a terminal that may be colored: a tty, NO_COLOR unset, TERM not dumb.
bool is_colored(const std::ostream& stream) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  if ((no_color && *no_color) || !term || std::strcmp(term, "dumb") == 0) return false;
  if (stream.rdbuf() == std::cout.rdbuf()) return isatty(STDOUT_FILENO) == 1;
  if (stream.rdbuf() == std::cerr.rdbuf()) return isatty(STDERR_FILENO) == 1;
  return false;
}

}  // namespace

std::string paint(const std::ostream& stream, Paint paint, const std::string& text) {
  return is_colored(stream) ? code_of(paint) + text + "\033[0m" : text;
}

std::string figure(double value, int digits) {
  if (!std::isfinite(value)) return value > 0 ? "inf" : value < 0 ? "-inf" : "-";
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  char buffer[64];
  if (size >= 1e7 || size < 1e-4) {
    std::snprintf(buffer, sizeof buffer, "%.*e", digits - 1, value);
  } else {
    const int before = static_cast<int>(std::floor(std::log10(size))) + 1;
    std::snprintf(buffer, sizeof buffer, "%.*f", std::max(0, digits - before), value);
  }
  return buffer;
}

std::string folded(const std::string& text, std::size_t indent) {
  std::string out;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    while (line.size() > kTerminalColumns) {
      const std::size_t cut = line.find_last_of(" ,", kTerminalColumns - 1);
      if (cut == std::string::npos || line.find_first_not_of(' ') > cut) break;
      out += line.substr(0, cut + (line[cut] == ',')) + "\n";
      line = std::string(indent, ' ') + line.substr(cut + 1);
    }
    out += line + (end < text.size() ? "\n" : "");
    from = end + 1;
  }
  return out;
}

void Table::print(std::ostream& stream) const {
  std::vector<std::size_t> widths;
  const auto measure = [&](const std::vector<std::string>& cells) {
    if (widths.size() < cells.size()) widths.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], width_of(cells[i]));
  };
  measure(header_);
  for (const auto& row : rows_) measure(row);
  const auto full_width = [&] {
    std::size_t sum = 0;
    for (const auto width : widths) sum += width == 0 ? 0 : width + 2;
    return sum < 2 ? 0 : sum - 2;
  };
  for (std::size_t i = 1; i < widths.size() && full_width() > kTerminalColumns; ++i)
    if (std::all_of(rows_.begin(), rows_.end(),
                    [i](const auto& row) { return row.size() <= i || row[i] == "0"; }))
      widths[i] = 0;
  const std::size_t total = full_width();
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (widths[i] == 0) continue;
      const std::string gap(widths[i] - width_of(cells[i]), ' ');
      text += (i ? "  " : "") + (i == 0 ? cells[i] + gap : gap + cells[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  };
  if (!header_.empty()) stream << paint(stream, Paint::bold, line(header_)) << '\n';
  for (const auto& row : rows_) stream << (row.empty() ? std::string(total, '-') : line(row)) << '\n';
}

}  // namespace joulepath
