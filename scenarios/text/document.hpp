#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/config_error.hpp"

namespace joulepath {

/// A YAML or JSON value with its place in the file, independent of the parser's types.
struct Value {
  enum class Kind { null, scalar, list, map };
  struct Entry;

  Kind kind{Kind::null};
  std::string text{};  ///< of a scalar
  bool quoted{};       ///< of a scalar: it is a string in any case
  int line{};
  int column{};
  std::vector<Value> items;
  std::vector<Entry> entries;  ///< in the file's order, keys unique
};

struct Value::Entry {
  std::string key{};
  int line{};
  int column{};
  Value value{};
};

/// Form of a place inside of a file in errors: `legs[2].to`, or `/legs/2/to` (RFC 6901) in JSON.
enum class PathStyle { dotted, pointer };
[[nodiscard]] std::string path_of_key(const std::string& path, std::string_view key, PathStyle style);
[[nodiscard]] std::string path_of_item(const std::string& path, std::size_t index, PathStyle style);

/// A value with typed access. Its errors name file, line, column and path. It refers to a Document, which
/// must outlive it.
class Node {
 public:
  Node(const Value& value, std::string_view file, std::string path, PathStyle style)
      : value_(&value), file_(file), path_(std::move(path)), style_(style) {}

  [[nodiscard]] Value::Kind kind() const { return value_->kind; }
  [[nodiscard]] const Value& value() const { return *value_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string path_of(std::string_view key) const { return path_of_key(path_, key, style_); }
  [[nodiscard]] SourceMark mark() const;

  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] std::optional<Node> find(
      std::string_view key) const;                            ///< absent also where the value is null
  [[nodiscard]] Node operator[](std::string_view key) const;  ///< throws ConfigError when absent
  [[nodiscard]] std::vector<Node> items() const;              ///< of a list
  [[nodiscard]] std::vector<std::pair<std::string, Node>> entries() const;

  [[nodiscard]] double number() const;
  [[nodiscard]] long integer() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] const std::string& text() const;

  [[nodiscard]] double number_or(std::string_view key, double fallback) const;
  [[nodiscard]] bool boolean_or(std::string_view key, bool fallback) const;
  [[nodiscard]] std::string text_or(std::string_view key, std::string_view fallback) const;
  [[nodiscard]] std::optional<double> optional_number(std::string_view key) const;

  /// The value here, shortened, for a message: `"abc"`, `a list of 3`, `a map with keys x_m, y_m`.
  [[nodiscard]] std::string described() const;
  [[noreturn]] void fail(std::string accepted, std::string hint = {}) const;
  [[noreturn]] void fail_found(std::string found, std::string accepted, std::string hint = {}) const;

 private:
  const Value* value_;
  std::string_view file_;
  std::string path_;
  PathStyle style_;
};

/// The place where a file is named, for errors about the file; empty, or an option: on the command line.
struct NamedBy {
  SourceMark mark{};
  std::string key{};  ///< dotted

  NamedBy() = default;
  NamedBy(SourceMark mark_, std::string key_) : mark(std::move(mark_)), key(std::move(key_)) {}
  explicit NamedBy(const Node& node) : mark(node.mark()), key(node.path()) {}

  /// An error about `file`, reported at the place that names it, or at the file itself.
  [[nodiscard]] ConfigError error(const std::string& file, std::string found, std::string accepted,
                                  std::string hint = {}) const;
};

/// Options for files that name other files.
struct ReadOptions {
  bool untrusted{};           ///< file names in the input must be relative and stay in the input's folder
  bool cut_long_logs{};       ///< long logs are cut at standstill into several runs
  bool keep_whole_drives{};   ///< leave channels out that a part of a log lacks, instead of cutting the log
  bool accept_implausible{};  ///< accept logs with numbers that no robot has; the caller reports them
};

/// A text that replaces a value of a document. Path: keys and items as in `legs[2].payload_kg`; `[*]` means
/// every item of a list or of a map. An absent key is added to its map.
struct ValueChange {
  std::string path{};
  std::string text{};
  NamedBy named_by{};  ///< the place for errors
};

/// One parsed file.
class Document {
 public:
  /// Parses JSON where the file's name ends with .json, .geojson, .jsonl or .ndjson, YAML otherwise. Throws
  /// ConfigError: syntax, not UTF-8, control character, duplicate key, several documents, too large.
  static Document parse(std::string_view text, std::string file, int first_line = 1);
  /// Reads and parses a file. Throws ConfigError if it cannot be read; `named_by` is the place of its name.
  static Document load(const std::string& file, const NamedBy& named_by = {});

  /// A copy with changed values. Throws ConfigError if a path does not exist.
  [[nodiscard]] Document with(const std::vector<ValueChange>& changes) const;

  [[nodiscard]] Node root() const { return {*root_, *file_, "", style_}; }
  [[nodiscard]] const std::string& file() const { return *file_; }

 private:
  std::unique_ptr<const std::string> file_;
  std::unique_ptr<const Value> root_;
  PathStyle style_{};
};

/// A file's whole content. Throws ConfigError when it cannot be read.
[[nodiscard]] std::string read_text_file(const std::string& file, const NamedBy& named_by = {});

/// Whether read_text_file() has read the file since the last forget_inputs(): a result must not replace it.
[[nodiscard]] bool is_input(const std::string& file);
void forget_input(const std::string& file);  ///< of a command's own result, read to continue a run
void forget_inputs();

/// The file that a node names, relative to the file that holds the node.
[[nodiscard]] std::string resolve_file(const Node& node, const ReadOptions& options);

/// A finite number in decimal notation as YAML 1.2 defines it; empty for any other text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The candidate nearest to a mistyped word, with one slip in so many letters; empty when none is near.
[[nodiscard]] std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates,
                                       int letters_per_slip = 3);

}  // namespace joulepath
