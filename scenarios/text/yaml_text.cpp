#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "model/printable.hpp"
#include "scenarios/text/value_builder.hpp"

namespace joulepath {
namespace {

/// The events of one YAML document as values with their places. An anchored value is kept for its aliases.
class YamlEvents : public YAML::EventHandler {
 public:
  YamlEvents(const std::string& text, std::string_view file, int first_line)
      : text_(text), builder_(file, PathStyle::dotted), first_line_(first_line) {}

  Value take() { return builder_.take(); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    const auto position = static_cast<std::size_t>(std::max(mark.pos, 0));
    if (text_.compare(std::min(position, text_.size()), 3, "---") == 0)
      builder_.fail(place(mark), "", "a second YAML document", "one", "remove the --- lines");
    builder_.fail(place(mark), "", "text after the end of the YAML document", "YAML",
                  "is a bracket, quote, comma or colon missing or extra here or on the line above?");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    builder_.null(place(mark));
    keep(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto kept = kept_.find(anchor);
    if (kept == kept_.end())
      builder_.fail(place(mark), "", "an alias inside of the value that it names", "a value without a cycle");
    builder_.copy(kept->second, place(mark));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    builder_.scalar(value, tag == "!", place(mark));
    if (anchor != YAML::NullAnchor) keep_value(mark, anchor, scalar_of(mark, tag, value));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(Value::Kind::list, mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(Value::Kind::map, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YAML::Mark mark{};
    YAML::anchor_t anchor{};
  };

  [[nodiscard]] ValueBuilder::Place place(const YAML::Mark& mark) const {
    return {.line = mark.line < 0 ? 0 : mark.line + first_line_,
            .column = mark.column < 0 ? 0 : mark.column + 1};
  }
  [[nodiscard]] Value scalar_of(const YAML::Mark& mark, const std::string& tag,
                                const std::string& text) const {
    Value value;
    value.kind = Value::Kind::scalar;
    value.text = printable(text);
    value.quoted = tag == "!";
    value.line = place(mark).line;
    value.column = place(mark).column;
    return value;
  }
  void open(Value::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    builder_.open(kind, place(mark));
    open_.push_back({mark, anchor});
  }
  void close() {
    builder_.close();
    const Open done = open_.back();
    open_.pop_back();
    keep(done.mark, done.anchor);
  }
  void keep(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) keep_value(mark, anchor, builder_.last());
  }
  void keep_value(const YAML::Mark& mark, YAML::anchor_t anchor, const Value& value) {
    builder_.count_copy(value, place(mark));
    kept_[anchor] = value;
  }

  const std::string& text_;
  ValueBuilder builder_;
  int first_line_;
  int documents_{};
  std::vector<Open> open_{};
  std::unordered_map<YAML::anchor_t, Value> kept_{};
};

std::string syntax_hint(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string current;
  for (int i = 0; i <= line && std::getline(lines, current); ++i) {
  }
  if (current.find('\t') != std::string::npos) return "YAML indents with spaces; this line holds a tab";
  return "is a bracket, quote, comma or colon missing here or on the line above?";
}

/// Without the line `---` that ROS prints after each message.
std::string without_end_line(const std::string& text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  const bool ends = last != std::string::npos && last >= 3 && text.compare(last - 3, 4, "\n---") == 0;
  return ends ? text.substr(0, last - 2) : text;
}

}  // namespace

Value read_yaml_text(const std::string& given, std::string_view file, int first_line) {
  const std::string text = without_end_line(given);
  YamlEvents events(text, file, first_line);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    // A stray comma makes yaml-cpp return an endless sequence of documents, so reading stops at the second
    // one.
    while (parser.HandleNextDocument(events)) {
    }
  } catch (const YAML::Exception& error) {
    const int line = error.mark.line < 0 ? 0 : error.mark.line;
    throw ConfigError({{std::string(file), line + first_line, std::max(0, error.mark.column) + 1},
                       "",
                       "text that is not YAML (" + error.msg + ")",
                       "YAML",
                       syntax_hint(text, line)});
  }
  return events.take();
}

}  // namespace joulepath
