#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "scenarios/document.hpp"

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
           "a smaller file");
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
        fail(entry.line, entry.column, full, "a duplicate key", "each key once",
             "the first one is on line " + std::to_string(same->line));
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

std::string syntax_hint(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string current;
  for (int i = 0; i <= line && std::getline(lines, current); ++i) {
  }
  if (current.find('\t') != std::string::npos) return "YAML indents with spaces; this line holds a tab";
  return "is a bracket, quote, comma or colon missing here or on the line above?";
}

}  // namespace

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

}  // namespace joulepath
