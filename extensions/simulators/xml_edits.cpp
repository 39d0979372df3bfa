#include "extensions/simulators/xml_edits.hpp"

#include <algorithm>
#include <cctype>

namespace joulepath {
namespace {

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// The character after a section that ends with a mark.
std::size_t after(const std::string& text, const std::string& mark, std::size_t from) {
  const std::size_t at = text.find(mark, from);
  return at == std::string::npos ? text.size() : at + mark.size();
}

/// The character after a start tag: a `>` outside of quotes.
std::size_t end_of_tag(const std::string& text, std::size_t from) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (quote != 0)
      quote = text[i] == quote ? '\0' : quote;
    else if (text[i] == '"' || text[i] == '\'')
      quote = text[i];
    else if (text[i] == '>')
      return i + 1;
  }
  return text.size();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t next = std::min(text.find('\n', at), text.size() - 1) + 1;
    lines.push_back(text.substr(at, next - at));
    at = next;
  }
  return lines;
}

/// Lines with a mark before each; the last line of a file may lack its end.
std::string marked(const std::vector<std::string>& lines, std::size_t begin, std::size_t end, char mark) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i)
    text += mark + lines[i] + (lines[i].back() == '\n' ? "" : "\n\\ No newline at end of file\n");
  return text;
}

/// `-12,3` of a hunk's head: first line and number of lines.
std::string range_text(std::size_t begin, std::size_t count) {
  return std::to_string(count > 0 ? begin + 1 : begin) + "," + std::to_string(count);
}

}  // namespace

XmlEdits::XmlEdits(std::string text) : text_(std::move(text)) {
  for (std::size_t at = text_.find('<'); at < text_.size(); at = text_.find('<', at)) {
    if (text_.compare(at, 4, "<!--") == 0) {
      at = after(text_, "-->", at);
    } else if (text_.compare(at, 9, "<![CDATA[") == 0) {
      at = after(text_, "]]>", at);
    } else {
      const std::size_t end = end_of_tag(text_, at);
      const char first = at + 1 < text_.size() ? text_[at + 1] : '/';
      if (first != '/' && first != '?' && first != '!') tags_.push_back({at, end, text_[end - 2] == '/'});
      at = end;
    }
  }
}

void XmlEdits::replace(std::size_t begin, std::size_t end, std::string with) {
  Change& change = changes_[begin];
  change = {end, begin == end ? change.with + with : std::move(with)};
}

std::string XmlEdits::name_of(const Tag& tag) const {
  std::size_t end = tag.begin + 1;
  while (!is_blank(text_[end]) && text_[end] != '/' && text_[end] != '>') ++end;
  return text_.substr(tag.begin + 1, end - tag.begin - 1);
}

void XmlEdits::set_attribute(std::size_t element, const std::string& name, const std::string& value) {
  const Tag& tag = tags_.at(element);
  for (std::size_t at = tag.begin + 1 + name_of(tag).size(); at < tag.end;) {
    while (is_blank(text_[at])) ++at;
    const std::size_t equals = text_.find('=', at);
    if (equals >= tag.end) break;
    std::size_t name_end = equals;
    while (is_blank(text_[name_end - 1])) --name_end;
    const std::size_t open = text_.find_first_of("\"'", equals), close = text_.find(text_[open], open + 1);
    if (text_.substr(at, name_end - at) == name) return replace(open + 1, close, value);
    at = close + 1;
  }
  std::size_t at = tag.end - (tag.is_empty ? 2 : 1);
  while (is_blank(text_[at - 1])) --at;
  replace(at, at, " " + name + "=\"" + value + "\"");
}

void XmlEdits::set_text(std::size_t element, const std::string& value) {
  const Tag& tag = tags_.at(element);
  if (tag.is_empty) return insert_child(element, value);
  std::size_t begin = tag.end, end = text_.find('<', begin);
  while (text_.compare(end, 4, "<!--") == 0) {  // the text stands behind comments, or ends at one
    if (!std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(begin),
                     text_.begin() + static_cast<std::ptrdiff_t>(end), is_blank))
      break;
    begin = after(text_, "-->", end);
    end = text_.find('<', begin);
  }
  while (begin < end && is_blank(text_[begin])) ++begin;
  while (end > begin && is_blank(text_[end - 1])) --end;
  replace(begin, end, value);
}

void XmlEdits::insert_child(std::size_t element, const std::string& child) {
  const Tag& tag = tags_.at(element);
  if (tag.is_empty)
    replace(tag.end - 2, tag.end, ">" + child + "</" + name_of(tag) + ">");
  else
    replace(tag.end, tag.end, child);
}

std::string XmlEdits::text() const {
  std::string changed;
  std::size_t at = 0;
  for (const auto& [begin, change] : changes_) {
    changed.append(text_, at, begin - at);
    changed += change.with;
    at = change.end;
  }
  return changed.append(text_, at);
}

std::string unified_diff(const std::string& before, const std::string& after, const std::string& name) {
  const std::vector<std::string> a = lines_of(before), b = lines_of(after);
  // Edits lie on a few lines: between two of them the lines agree one by one.
  std::string hunks;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      ++i, ++j;
      continue;
    }
    std::size_t end_a = a.size(), end_b = b.size();
    for (std::size_t skipped = 1; skipped < a.size() + b.size() - i - j; ++skipped) {
      bool met = false;
      for (std::size_t k = 0; k <= skipped && !met; ++k) {
        const std::size_t x = i + k, y = j + skipped - k;
        if (x >= a.size() || y >= b.size() || a[x] != b[y]) continue;
        met = true, end_a = x, end_b = y;
      }
      if (met) break;
    }
    hunks += "@@ -" + range_text(i, end_a - i) + " +" + range_text(j, end_b - j) + " @@\n" +
             marked(a, i, end_a, '-') + marked(b, j, end_b, '+');
    i = end_a, j = end_b;
  }
  return hunks.empty() ? "" : "--- " + name + "\n+++ " + name + "\n" + hunks;
}

}  // namespace joulepath
