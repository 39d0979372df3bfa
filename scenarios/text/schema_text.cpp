#include "scenarios/text/schema_text.hpp"

#include <limits>
#include <sstream>

namespace joulepath {
namespace {

std::vector<std::string> parts_of(const std::string& phrase) {
  std::vector<std::string> parts;
  for (std::size_t start = 0, end = 0; end != std::string::npos; start = end + 2) {
    end = phrase.find(", ", start);
    parts.push_back(phrase.substr(start, end - start));
  }
  return parts;
}

class SchemaReader {
 public:
  SchemaReader(const Node& root, bool open, const GivenSchemas& given)
      : root_(root), open_(open), given_(given) {}

  [[nodiscard]] Schema named(const std::string& name) const {
    const auto found = given_.find(name);
    return found == given_.end() ? value(root_[name]) : found->second;
  }

 private:
  [[nodiscard]] Schema value(const Node& node) const {
    if (node.kind() == Value::Kind::scalar) return phrase(node.text());
    Schema schema = map({});
    schema.open = open_;
    for (const auto& [name, entry] : node.entries()) {
      if (name == "(exactly one)") {
        schema.exactly_one.push_back(parts_of(entry.text()));
        continue;
      }
      const bool says = entry.kind() == Value::Kind::list, may_be_absent = name.ends_with('?');
      schema.keys.push_back({.name = name.substr(0, name.size() - (may_be_absent ? 1 : 0)),
                             .schema = value(says ? entry.items()[0] : entry),
                             .says = says ? entry.items()[1].text() : "",
                             .required = !may_be_absent});
    }
    return schema;
  }

  [[nodiscard]] Schema phrase(const std::string& words) const {
    constexpr std::string_view kOrNull = " or null";
    if (words.ends_with(kOrNull)) return nullable(phrase(words.substr(0, words.size() - kOrNull.size())));
    std::istringstream stream(words);
    std::string first, second;
    stream >> first >> second;
    const auto rest = [&] {
      std::string text;
      std::getline(stream >> std::ws, text);
      return text;
    };
    if (first == "number" || first == "integer") {
      const Range range = range_in(stream, second);
      return first == "number" ? number(range) : integer(range);
    }
    if (words == "boolean") return boolean();
    if (words == "text") return text();
    if (first == "sided") return sided(phrase(words.substr(6)));
    if (const auto count = parse_number(first))
      return list_of(static_cast<std::size_t>(*count), second, stream);
    if (second == "of") {
      if (first == "list") return list(phrase(rest()));
      if (first == "map") return dictionary(phrase(rest()));
      if (first == "one") return choice(parts_of(rest()));
      std::vector<Schema> alternatives;
      for (const std::string& part : parts_of(rest())) alternatives.push_back(phrase(part));
      return any_of(std::move(alternatives));
    }
    return named(words);
  }

  static Range range_in(std::istringstream& stream, std::string word) {
    Range range;
    if (word == "from" || word == "above") {
      range.above_min = word == "above";
      stream >> range.min >> word;
    }
    if (word == "to") stream >> range.max;
    return range;
  }

  /// "N of X", "N or more X", "N to M of X"
  [[nodiscard]] Schema list_of(std::size_t least, const std::string& word, std::istringstream& stream) const {
    std::size_t most = word == "of" ? least : std::numeric_limits<std::size_t>::max();
    std::string skipped, item;
    if (word == "to") stream >> most >> skipped;
    if (word == "or") stream >> skipped;
    std::getline(stream >> std::ws, item);
    return list(phrase(item), least, most);
  }

  Node root_;
  bool open_;
  const GivenSchemas& given_;
};

}  // namespace

Schema schema_in(std::string_view document, const std::string& name, bool open, const GivenSchemas& given) {
  const Document parsed = Document::parse(document, name);
  return SchemaReader(parsed.root(), open, given).named(name);
}

}  // namespace joulepath
