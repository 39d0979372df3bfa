#pragma once

#include <string>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// Places of values in a text, as offsets.
struct Span {
  std::size_t begin{};
  std::size_t end{};
};

/// Places of the values of one text in YAML (or JSON, which is YAML's flow style).
class TextSpans {
 public:
  explicit TextSpans(const std::string& text);

  [[nodiscard]] std::size_t offset(int line, int column) const;
  /// From a value's first character to the end of the last one, without comments. `in_flow`: inside braces or
  /// brackets.
  [[nodiscard]] Span of(const Value& value, bool in_flow) const;
  /// True if a map or a list is written with braces or brackets.
  [[nodiscard]] bool is_flow(const Value& value) const;
  /// Offset after the line break of the line at an offset.
  [[nodiscard]] std::size_t line_end(std::size_t at) const;
  [[nodiscard]] std::size_t line_begin(std::size_t at) const;

 private:
  [[nodiscard]] std::size_t quoted_end(std::size_t begin) const;
  [[nodiscard]] std::size_t flow_end(std::size_t begin) const;
  [[nodiscard]] std::size_t plain_end(std::size_t begin, bool in_flow) const;

  const std::string& text_;
  std::vector<std::size_t> lines_{};
};

}  // namespace joulepath
