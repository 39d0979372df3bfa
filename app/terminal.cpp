#include "app/terminal.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <streambuf>

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

bool is_terminal(const std::ostream& stream) {
  if (stream.rdbuf() == std::cout.rdbuf()) return isatty(STDOUT_FILENO) == 1;
  if (stream.rdbuf() == std::cerr.rdbuf()) return isatty(STDERR_FILENO) == 1;
  return false;
}

/// Whether the stream is a terminal that may be colored: a tty, NO_COLOR unset, TERM not dumb.
bool is_colored(const std::ostream& stream) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  if ((no_color && *no_color) || !term || std::strcmp(term, "dumb") == 0) return false;
  return is_terminal(stream);
}

/// Bytes of a line that fit into so many columns: colors and the further bytes of a character take none.
std::size_t bytes_within(const std::string& line, std::size_t columns) {
  bool in_color = false;
  for (std::size_t k = 0, used = 0; k < line.size(); ++k) {
    if (line[k] == '\033') in_color = true;
    if (!in_color && (static_cast<unsigned char>(line[k]) & 0xC0) != 0x80 && ++used > columns) return k;
    if (line[k] == 'm') in_color = false;
  }
  return line.size();
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
  indent = std::min(indent, kTerminalColumns / 2);
  std::string out;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    for (std::size_t room = 0; (room = bytes_within(line, kTerminalColumns)) < line.size();) {
      std::size_t cut = line.find_last_of(" ,", room - 1);
      if (cut == std::string::npos || line.find_first_not_of(' ') > cut) cut = line.find(' ', room);
      if (cut == std::string::npos) break;
      out += line.substr(0, cut + (line[cut] == ',')) + "\n";
      line = std::string(indent, ' ') + line.substr(cut + 1);
    }
    out += line + (end < text.size() ? "\n" : "");
    from = end + 1;
  }
  return out;
}

/// Passes complete lines on, folded: what follows stands two columns further right than the line.
class FoldingBuffer : public std::streambuf {
 public:
  explicit FoldingBuffer(std::streambuf& to) : to_(to) {}
  FoldingBuffer(const FoldingBuffer&) = delete;
  FoldingBuffer& operator=(const FoldingBuffer&) = delete;
  ~FoldingBuffer() override { pass_on(); }

  [[nodiscard]] std::streambuf& target() { return to_; }
  void keep_whole(const std::string& text) {
    pass_on();
    to_.sputn(text.data(), static_cast<std::streamsize>(text.size()));
  }

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    line_ += traits_type::to_char_type(c);
    return line_.back() != '\n' || pass_on() ? c : traits_type::eof();
  }

  int sync() override { return to_.pubsync(); }

 private:
  bool pass_on() {
    const std::string text = folded(line_, std::min(line_.find_first_not_of(' '), line_.size()) + 2);
    line_.clear();
    const auto size = static_cast<std::streamsize>(text.size());
    return to_.sputn(text.data(), size) == size;
  }

  std::streambuf& to_;
  std::string line_{};
};

FoldedTerminal::FoldedTerminal(std::ostream& stream)
    : stream_(stream),
      buffer_(is_terminal(stream) ? std::make_unique<FoldingBuffer>(*stream.rdbuf()) : nullptr) {
  if (buffer_) stream_.rdbuf(buffer_.get());
}

FoldedTerminal::~FoldedTerminal() {
  if (buffer_) stream_.rdbuf(&buffer_->target());
}

void print_whole_lines(std::ostream& stream, const std::string& text) {
  if (auto* const folding = dynamic_cast<FoldingBuffer*>(stream.rdbuf()))
    folding->keep_whole(text);
  else
    stream << text;
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
