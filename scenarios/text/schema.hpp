#pragma once

#include <limits>
#include <string>
#include <vector>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// Accepted numbers.
struct Range {
  double min{-std::numeric_limits<double>::infinity()};
  double max{std::numeric_limits<double>::infinity()};
  bool above_min{};     ///< min itself is not accepted
  double least_size{};  ///< a value other than 0 has at least this size
  const char* why{};    ///< the reason of the bounds, for the message; null: none
};

inline constexpr Range kAny{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range kNotNegative{0.0};
inline constexpr Range kFraction{0.0, 1.0};

/// The accepted values of a key; readers, JSON Schemas and error messages all use this description.
struct Schema {
  enum class Kind { number, integer, boolean, text, choice, list, map, dictionary, any_of };
  struct Key;

  Kind kind{Kind::map};
  Range range{};                       ///< number, integer
  std::vector<std::string> choices{};  ///< choice
  std::vector<Schema>
      parts{};              ///< list, dictionary: the item; any_of: alternatives, each of a different shape
  std::size_t min_items{};  ///< list: least number of items; map: least number of keys
  std::size_t max_items{std::numeric_limits<std::size_t>::max()};
  std::vector<Key> keys;  ///< map
  bool open{};            ///< map: unnamed keys are accepted (results may get further keys)
  bool nullable{};        ///< null is accepted (results: a number that is not finite)
  std::vector<std::vector<std::string>> exactly_one{};  ///< map: exactly one key of each group is required

  Schema with_exactly_one(std::vector<std::string> group) &&;
};

struct Schema::Key {
  std::string name{};
  Schema schema{};
  std::string says{};  ///< one sentence for editors
  bool required{};
};

[[nodiscard]] Schema number(Range range = kAny);
[[nodiscard]] Schema integer(Range range = kAny);
[[nodiscard]] Schema boolean();
[[nodiscard]] Schema text();
[[nodiscard]] Schema choice(std::vector<std::string> words);
[[nodiscard]] Schema list(Schema item, std::size_t min_items = 0,
                          std::size_t max_items = std::numeric_limits<std::size_t>::max());
[[nodiscard]] Schema map(std::vector<Schema::Key> keys);
[[nodiscard]] Schema dictionary(Schema item);  ///< any keys
[[nodiscard]] Schema any_of(std::vector<Schema> alternatives);
[[nodiscard]] Schema sided(const Schema& value);  ///< the value, or {left: , right: }
[[nodiscard]] Schema open(Schema map);            ///< the map, with keys of any other name
[[nodiscard]] Schema nullable(Schema value);      ///< the value, or null
[[nodiscard]] Schema::Key required(std::string name, Schema schema, std::string says = {});
[[nodiscard]] Schema::Key optional(std::string name, Schema schema, std::string says = {});

/// A kind of file, as in `schema: joulepath/KIND/1`; `map` is Nav2's format without such a line.
struct FileKind {
  std::string name{};
  Schema (*schema)(){};
  std::string says{};
};

/// The accepted values in words: `a number > 0`, `one of: wheel, bus`.
[[nodiscard]] std::string accepted_by(const Schema& schema);

/// Checks a value and all values below it. Throws ConfigError at the first mistake.
void check_value(const Node& node, const Schema& schema);

/// JSON Schema (draft 2020-12) of a kind, pretty-printed.
[[nodiscard]] std::string json_schema(const FileKind& kind);

}  // namespace joulepath
