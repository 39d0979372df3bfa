#pragma once

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace joulepath {

enum class Paint { error, warning, good, dim, bold };

/// The text in a color if the stream supports it.
[[nodiscard]] std::string paint(const std::ostream& stream, Paint paint, const std::string& text);

/// A number with this many significant digits, without an exponent for ordinary sizes.
[[nodiscard]] std::string figure(double value, int digits = 4);

/// Columns of a terminal that texts keep within, as far as their words allow.
constexpr std::size_t kTerminalColumns = 110;

/// Lines above that width are broken at spaces and commas; what follows is indented.
[[nodiscard]] std::string folded(const std::string& text, std::size_t indent);

class FoldingBuffer;

/// While it lives, the lines of std::cout or std::cerr are folded where they are shown on a terminal. Files
/// and pipes get whole lines: other programs read `file:line:column: key: ...`.
class FoldedTerminal {
 public:
  explicit FoldedTerminal(std::ostream& stream);
  FoldedTerminal(const FoldedTerminal&) = delete;
  FoldedTerminal& operator=(const FoldedTerminal&) = delete;
  ~FoldedTerminal();

 private:
  std::ostream& stream_;
  std::unique_ptr<FoldingBuffer> buffer_;  ///< null: no terminal
};

/// Writes the text of a file; its lines stay whole on a terminal, too.
void print_whole_lines(std::ostream& stream, const std::string& text);

/// A plain table: first column left, the others right; widths from the content (UTF-8 counts by character).
/// A table that would be too wide leaves out its columns of zeros.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  void rule() { rows_.emplace_back(); }  ///< a line across
  void print(std::ostream& stream) const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_{};
};

}  // namespace joulepath
