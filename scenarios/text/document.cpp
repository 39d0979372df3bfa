#include "scenarios/text/document.hpp"

#include <algorithm>
#include <cmath>

#include "model/printable.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

std::string shortened(const std::string& text) { return printable_start(text, 60); }

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates,
                         int letters_per_slip) {
  std::string best;
  int best_distance = std::max(2, static_cast<int>(word.size()) / letters_per_slip) + 1;
  for (const auto& candidate : candidates) {
    int distance = edit_distance(word, candidate);
    // The most frequent slip is a missing or different unit: `speed` for `speed_m_s`.
    if (word.size() >= 3 && candidate.size() > word.size() && candidate.compare(0, word.size(), word) == 0 &&
        candidate[word.size()] == '_')
      distance = std::min(distance, 1);
    if (candidate.size() >= 5 && word.starts_with(candidate)) distance = std::min(distance, 2);  // --output
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string path_of_key(const std::string& path, std::string_view key, PathStyle style) {
  if (style == PathStyle::dotted) return (path.empty() ? "" : path + ".") + std::string(key);
  std::string pointer = path + "/";
  for (const char c : key) pointer += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return pointer;
}

std::string path_of_item(const std::string& path, std::size_t index, PathStyle style) {
  const std::string number = std::to_string(index);
  return style == PathStyle::dotted ? path + "[" + number + "]" : path + "/" + number;
}

SourceMark Node::mark() const { return {std::string(file_), value_->line, value_->column}; }

bool Node::has(std::string_view key) const { return find(key).has_value(); }

std::optional<Node> Node::find(std::string_view key) const {
  for (const auto& entry : value_->entries)
    if (entry.key == key && entry.value.kind != Value::Kind::null)
      return Node(entry.value, file_, path_of(entry.key), style_);
  return std::nullopt;
}

Node Node::operator[](std::string_view key) const {
  if (auto node = find(key)) return *std::move(node);
  throw ConfigError({mark(), path_of(key), "nothing", "this key is required", ""});
}

std::vector<Node> Node::items() const {
  if (kind() != Value::Kind::list) fail("a list");
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < value_->items.size(); ++i)
    nodes.emplace_back(value_->items[i], file_, path_of_item(path_, i, style_), style_);
  return nodes;
}

std::vector<std::pair<std::string, Node>> Node::entries() const {
  if (kind() != Value::Kind::map) fail("a map (key: value)");
  std::vector<std::pair<std::string, Node>> nodes;
  for (const auto& entry : value_->entries)
    nodes.emplace_back(entry.key, Node(entry.value, file_, path_of(entry.key), style_));
  return nodes;
}

double Node::number() const {
  if (kind() != Value::Kind::scalar) fail("a number");
  if (value_->quoted) fail("a number", "remove the quotes");
  if (const auto parsed = parse_number(value_->text)) return *parsed;
  const std::string& text = value_->text;
  std::string hint;
  const auto comma = text.find(',');
  const std::string lower = [&] {
    std::string copy = text;
    for (char& c : copy) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return copy;
  }();
  if (lower.find("nan") != std::string::npos || lower.find("inf") != std::string::npos)
    hint = "omit the key if there is no value or no limit";
  else if (text.find_first_not_of("+-0123456789.eE") == std::string::npos)
    hint = "it is too large, or not written as a number";
  else if (comma != std::string::npos)
    hint = "the decimal sign is a point";
  else if (!text.empty() && (std::isdigit(static_cast<unsigned char>(text.front())) || text.front() == '-'))
    hint = "the unit is part of the key; write the number alone";
  fail("a finite number", hint);
}

long Node::integer() const {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > 1e15) fail("a whole number");
  return static_cast<long>(value);
}

bool Node::boolean() const {
  if (kind() == Value::Kind::scalar && !value_->quoted) {
    for (const char* yes : {"true", "True", "TRUE"})
      if (value_->text == yes) return true;
    for (const char* no : {"false", "False", "FALSE"})
      if (value_->text == no) return false;
  }
  fail("true or false");
}

const std::string& Node::text() const {
  if (kind() != Value::Kind::scalar) fail("a text");
  return value_->text;
}

double Node::number_or(std::string_view key, double fallback) const {
  const auto node = find(key);
  return node ? node->number() : fallback;
}

bool Node::boolean_or(std::string_view key, bool fallback) const {
  const auto node = find(key);
  return node ? node->boolean() : fallback;
}

std::string Node::text_or(std::string_view key, std::string_view fallback) const {
  const auto node = find(key);
  return node ? node->text() : std::string(fallback);
}

std::optional<double> Node::optional_number(std::string_view key) const {
  const auto node = find(key);
  return node ? std::optional(node->number()) : std::nullopt;
}

std::string Node::described() const {
  switch (kind()) {
    case Value::Kind::null:
      return "nothing";
    case Value::Kind::scalar:
      return value_->quoted ? "the text \"" + shortened(value_->text) + "\"" : shortened(value_->text);
    case Value::Kind::list:
      if (!value_->items.empty() && value_->items.size() <= 4 &&
          std::all_of(value_->items.begin(), value_->items.end(),
                      [](const Value& item) { return item.kind == Value::Kind::scalar; })) {
        return "[" + text_of_list(value_->items, [](const Value& item) { return shortened(item.text); }) +
               "]";
      }
      return value_->items.empty() ? "an empty list" : "a list of " + std::to_string(value_->items.size());
    case Value::Kind::map:
      break;
  }
  std::string keys;
  for (std::size_t i = 0; i < value_->entries.size() && i < 4; ++i)
    keys += (i ? ", " : "") + shortened(value_->entries[i].key);
  if (value_->entries.size() > 4) keys += ", ...";
  return value_->entries.empty() ? "an empty map" : "a map with " + keys;
}

void Node::fail(std::string accepted, std::string hint) const {
  fail_found(described(), std::move(accepted), std::move(hint));
}

void Node::fail_found(std::string found, std::string accepted, std::string hint) const {
  throw ConfigError({mark(), path_, std::move(found), std::move(accepted), std::move(hint)});
}

}  // namespace joulepath
