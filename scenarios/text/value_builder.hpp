#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// Builds a tree of values from a parser's events; line breaks, tabs and marks of direction in its texts are
/// escaped by their codes. Refuses duplicate keys, other control characters in texts, nesting deeper than
/// kMaxDepth and more than kMaxValues values (copies of aliases count), so that memory is bounded for any
/// text. Time is linear in the number of events.
class ValueBuilder {
 public:
  static constexpr std::size_t kMaxDepth = 64;
  static constexpr std::size_t kMaxValues = 2'000'000;

  struct Place {
    int line{};
    int column{};
  };

  ValueBuilder(std::string_view file, PathStyle style) : file_(file), style_(style) {}

  void open(Value::Kind kind, Place place);  ///< a list or a map
  void close();
  void scalar(std::string text, bool quoted, Place place);  ///< where a map expects a key: its key
  void key(std::string text, Place place);
  void null(Place place);
  void copy(const Value& value, Place place);  ///< an alias

  /// Adds an anchor's copy to the count.
  void count_copy(const Value& value, Place place);
  [[nodiscard]] const Value& last() const { return *last_; }  ///< the value completed last
  [[nodiscard]] Value take() { return std::move(root_); }

  [[noreturn]] void fail(Place place, std::string key, std::string found, std::string accepted,
                         std::string hint = {}) const;

 private:
  struct Frame {
    Value* value{};
    std::unordered_map<std::string, int> line_of_key{};
    bool has_key{};  ///< map: the key of the next value is set
  };

  Value& place_for(Place place);
  void count(std::size_t values, Place place);
  void take_text(std::string& text, Place place) const;
  [[nodiscard]] bool wants_key() const;
  [[nodiscard]] std::string path() const;

  std::string_view file_;
  PathStyle style_;
  Value root_{};
  std::vector<Frame> open_{};
  Value* last_{};
  std::size_t count_{};
};

/// The events of a JSON text (RFC 8259) or of the one document of a YAML text. `first_line` is the number of
/// the text's first line. Throws ConfigError.
[[nodiscard]] Value read_json_text(const std::string& text, std::string_view file, int first_line);
[[nodiscard]] Value read_yaml_text(const std::string& text, std::string_view file, int first_line);

}  // namespace joulepath
