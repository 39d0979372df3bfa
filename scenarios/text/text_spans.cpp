#include "scenarios/text/text_spans.hpp"

#include <algorithm>

namespace joulepath {

TextSpans::TextSpans(const std::string& text) : text_(text) {
  lines_.push_back(0);
  for (std::size_t k = 0; k < text.size(); ++k)
    if (text[k] == '\n') lines_.push_back(k + 1);
}

std::size_t TextSpans::offset(int line, int column) const {
  const auto index = static_cast<std::size_t>(std::max(line - 1, 0));
  if (index >= lines_.size()) return text_.size();
  return std::min(lines_[index] + static_cast<std::size_t>(std::max(column - 1, 0)), text_.size());
}

std::size_t TextSpans::line_begin(std::size_t at) const {
  return *std::prev(std::upper_bound(lines_.begin(), lines_.end(), at));
}

std::size_t TextSpans::line_end(std::size_t at) const {
  const std::size_t end = text_.find('\n', at);
  return end == std::string::npos ? text_.size() : end + 1;
}

std::size_t TextSpans::quoted_end(std::size_t begin) const {
  const char quote = text_[begin];
  for (std::size_t k = begin + 1; k < text_.size(); ++k) {
    if (quote == '"' && text_[k] == '\\') {
      ++k;
    } else if (text_[k] == quote) {
      if (quote != '\'' || k + 1 >= text_.size() || text_[k + 1] != '\'') return k + 1;
      ++k;
    }
  }
  return text_.size();
}

std::size_t TextSpans::flow_end(std::size_t begin) const {
  int depth = 0;
  for (std::size_t k = begin; k < text_.size(); ++k) {
    const char c = text_[k];
    const bool after_space = k == 0 || text_[k - 1] == ' ' || text_[k - 1] == '\n' || text_[k - 1] == '\t';
    const bool may_quote = after_space || text_[k - 1] == '[' || text_[k - 1] == '{' || text_[k - 1] == ',' ||
                           text_[k - 1] == ':';
    if ((c == '"' || c == '\'') && may_quote)
      k = quoted_end(k) - 1;
    else if (c == '#' && after_space)
      k = line_end(k) - 1;
    else if (c == '{' || c == '[')
      ++depth;
    else if ((c == '}' || c == ']') && --depth == 0)
      return k + 1;
  }
  return text_.size();
}

std::size_t TextSpans::plain_end(std::size_t begin, bool in_flow) const {
  std::size_t k = begin;
  for (; k < text_.size() && text_[k] != '\n' && text_[k] != '\r'; ++k) {
    if (in_flow && (text_[k] == ',' || text_[k] == '}' || text_[k] == ']')) break;
    if (text_[k] == '#' && k > begin && (text_[k - 1] == ' ' || text_[k - 1] == '\t')) break;
  }
  while (k > begin && (text_[k - 1] == ' ' || text_[k - 1] == '\t')) --k;
  return k;
}

bool TextSpans::is_flow(const Value& value) const {
  const std::size_t begin = offset(value.line, value.column);
  return begin < text_.size() && (text_[begin] == '{' || text_[begin] == '[');
}

Span TextSpans::of(const Value& value, bool in_flow) const {
  const std::size_t begin = offset(value.line, value.column);
  if (begin >= text_.size()) return {begin, begin};
  if (value.kind == Value::Kind::list || value.kind == Value::Kind::map) {
    if (is_flow(value)) return {begin, flow_end(begin)};
    const bool list = value.kind == Value::Kind::list;
    if (list ? value.items.empty() : value.entries.empty()) return {begin, begin};
    return {begin, of(list ? value.items.back() : value.entries.back().value, false).end};
  }
  if (text_[begin] == '"' || text_[begin] == '\'') return {begin, quoted_end(begin)};
  return {begin, plain_end(begin, in_flow)};
}

}  // namespace joulepath
