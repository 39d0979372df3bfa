#include "scenarios/document.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

namespace joulepath {
namespace {

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxValues = 2'000'000;

/// Copies yaml-cpp's tree into ours; finds duplicate keys, cycles and bombs of aliases.
class TreeBuilder {
 public:
  TreeBuilder(const std::string& file, int first_line) : file_(file), first_line_(first_line) {}

  Value build(const YAML::Node& node, int depth, const std::string& path = "") {
    Value value;
    set_mark(node.Mark(), value.line, value.column);
    if (depth > kMaxDepth || ++count_ > kMaxValues)
      fail(value.line, value.column, "",
           depth > kMaxDepth ? "lists and maps more than 64 deep" : "more than 2,000,000 values",
           "a file of ordinary size");
    switch (node.Type()) {
      case YAML::NodeType::Scalar:
        value.kind = Value::Kind::scalar;
        value.text = node.Scalar();
        value.quoted = node.Tag() == "!";
        break;
      case YAML::NodeType::Sequence:
        value.kind = Value::Kind::list;
        for (const auto& item : node)
          value.items.push_back(
              build(item, depth + 1, path + "[" + std::to_string(value.items.size()) + "]"));
        break;
      case YAML::NodeType::Map:
        build_map(node, depth, path, value);
        break;
      default:
        value.kind = Value::Kind::null;
    }
    return value;
  }

 private:
  void build_map(const YAML::Node& node, int depth, const std::string& path, Value& value) {
    value.kind = Value::Kind::map;
    for (const auto& pair : node) {
      Value::Entry entry;
      set_mark(pair.first.Mark(), entry.line, entry.column);
      if (!pair.first.IsScalar())
        fail(entry.line, entry.column, "", "a key that is a list or a map", "a word as key");
      entry.key = pair.first.Scalar();
      const std::string full = path.empty() ? entry.key : path + "." + entry.key;
      const auto same = std::find_if(value.entries.begin(), value.entries.end(),
                                     [&](const Value::Entry& other) { return other.key == entry.key; });
      if (same != value.entries.end())
        fail(entry.line, entry.column, full, "the key a second time", "each key once",
             "it stands on line " + std::to_string(same->line) + " already");
      entry.value = build(pair.second, depth + 1, full);
      if (entry.value.kind == Value::Kind::null)
        entry.value.line = entry.line, entry.value.column = entry.column;
      value.entries.push_back(std::move(entry));
    }
  }

  void set_mark(const YAML::Mark& mark, int& line, int& column) const {
    line = mark.line < 0 ? 0 : mark.line + first_line_;
    column = mark.column < 0 ? 0 : mark.column + 1;
  }

  [[noreturn]] void fail(int line, int column, std::string key, std::string found, std::string accepted,
                         std::string hint = {}) const {
    throw ConfigError(
        {{file_, line, column}, std::move(key), std::move(found), std::move(accepted), std::move(hint)});
  }

  const std::string& file_;
  int first_line_;
  std::size_t count_{};
};

constexpr std::string_view kDataDirectory = "${JOULEPATH_DATA_DIR}";

/// The text of a node with ${JOULEPATH_DATA_DIR} at its beginning filled in from the environment.
std::string with_data_directory(const Node& node, const ReadOptions& options) {
  const std::string& name = node.text();
  if (options.untrusted || name.compare(0, kDataDirectory.size(), kDataDirectory) != 0) return name;
  const char* folder = std::getenv("JOULEPATH_DATA_DIR");
  if (!folder)
    node.fail("a file; the environment variable JOULEPATH_DATA_DIR is not set",
              "set it to the folder that holds the data");
  return std::string(folder) + name.substr(kDataDirectory.size());
}

std::string shortened(const std::string& text) {
  std::string clean;
  for (const char c : text) clean += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  return clean.size() > 60 ? clean.substr(0, 57) + "..." : clean;
}

std::string syntax_hint(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string current;
  for (int i = 0; i <= line && std::getline(lines, current); ++i) {
  }
  if (current.find('\t') != std::string::npos) return "YAML indents with spaces; this line holds a tab";
  return "is a bracket, quote, comma or colon missing here or on the line above?";
}

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

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) return std::nullopt;
  }
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  int best_distance = std::max(2, static_cast<int>(word.size()) / 3) + 1;
  for (const auto& candidate : candidates) {
    int distance = edit_distance(word, candidate);
    // The unit left out (or another one) is the commonest slip: `speed` for `speed_m_s`.
    if (word.size() >= 3 && candidate.size() > word.size() && candidate.compare(0, word.size(), word) == 0 &&
        candidate[word.size()] == '_')
      distance = std::min(distance, 1);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

SourceMark Node::mark() const { return {std::string(file_), value_->line, value_->column}; }

bool Node::has(std::string_view key) const { return find(key).has_value(); }

std::optional<Node> Node::find(std::string_view key) const {
  for (const auto& entry : value_->entries)
    if (entry.key == key && entry.value.kind != Value::Kind::null)
      return Node(entry.value, file_, path_.empty() ? entry.key : path_ + "." + entry.key);
  return std::nullopt;
}

Node Node::operator[](std::string_view key) const {
  if (auto node = find(key)) return *std::move(node);
  const std::string full = path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  throw ConfigError({mark(), full, "nothing", "this key is required", ""});
}

std::vector<Node> Node::items() const {
  if (kind() != Value::Kind::list) fail("a list");
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < value_->items.size(); ++i)
    nodes.emplace_back(value_->items[i], file_, path_ + "[" + std::to_string(i) + "]");
  return nodes;
}

std::vector<std::pair<std::string, Node>> Node::entries() const {
  if (kind() != Value::Kind::map) fail("a map (key: value)");
  std::vector<std::pair<std::string, Node>> nodes;
  for (const auto& entry : value_->entries)
    nodes.emplace_back(entry.key,
                       Node(entry.value, file_, path_.empty() ? entry.key : path_ + "." + entry.key));
  return nodes;
}

double Node::number() const {
  if (kind() != Value::Kind::scalar) fail("a number");
  if (value_->quoted) fail("a number", "leave the quotes away");
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
    hint = "leave the key away where there is no value or no limit";
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
        std::string items;
        for (const auto& item : value_->items) items += (items.empty() ? "" : ", ") + shortened(item.text);
        return "[" + items + "]";
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

Document Document::parse(std::string_view text, std::string file, int first_line) {
  Document document;
  document.file_ = std::make_unique<const std::string>(std::move(file));
  const std::string copy(text);
  if (copy.find('\0') != std::string::npos)
    throw ConfigError({{document.file(), 0, 0}, "", "binary data", "a text file in YAML", ""});
  try {
    const std::vector<YAML::Node> roots = YAML::LoadAll(copy);
    if (roots.size() > 1)
      throw ConfigError({{document.file(), 0, 0},
                         "",
                         std::to_string(roots.size()) + " YAML documents",
                         "one",
                         "remove the --- lines"});
    TreeBuilder builder(document.file(), first_line);
    document.root_ = std::make_unique<const Value>(roots.empty() ? Value{} : builder.build(roots.front(), 0));
  } catch (const YAML::Exception& error) {
    const int line = error.mark.line < 0 ? 0 : error.mark.line;
    throw ConfigError({{document.file(), line + first_line, std::max(0, error.mark.column) + 1},
                       "",
                       "text that is not YAML (" + error.msg + ")",
                       "YAML",
                       syntax_hint(copy, line)});
  }
  return document;
}

Document Document::load(const std::string& file, const NamedBy& named_by) {
  return parse(read_text_file(file, named_by), file);
}

ConfigError NamedBy::error(const std::string& file, std::string found, std::string accepted,
                           std::string hint) const {
  if (mark.file.empty())
    return ConfigError({{file, 0, 0}, "", std::move(found), std::move(accepted), std::move(hint)});
  return ConfigError({mark, key, file + ", " + found, std::move(accepted), std::move(hint)});
}

std::string read_text_file(const std::string& file, const NamedBy& named_by) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw named_by.error(file, "a directory", "a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream && errno == EACCES) throw std::system_error(errno, std::generic_category(), file);
  if (!stream)
    throw named_by.error(
        file, std::string("no readable file (") + std::strerror(errno) + ")", "a file that can be read",
        named_by.mark.file.empty() ? "" : "relative paths are relative to the file that names them");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw named_by.error(file, "a file that cannot be read to its end", "a readable file");
  return text;
}

std::string resolve_file(const Node& node, const ReadOptions& options) {
  namespace fs = std::filesystem;
  const fs::path name = with_data_directory(node, options);
  if (name.empty()) node.fail_found("an empty text", "the name of a file");
  const fs::path folder = fs::path(node.mark().file).parent_path();
  const fs::path resolved = name.is_absolute() ? name : folder / name;
  if (options.untrusted) {
    const std::string accepted = "a path inside of the input's folder";
    const std::string hint = "the input is read as untrusted";
    if (name.is_absolute()) node.fail(accepted, hint);
    std::error_code error;
    const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
    const fs::path target = fs::weakly_canonical(resolved, error);
    const auto mismatch = std::mismatch(base.begin(), base.end(), target.begin(), target.end());
    if (error || mismatch.first != base.end()) node.fail(accepted, hint);
  }
  return resolved.lexically_normal().string();
}

}  // namespace joulepath
