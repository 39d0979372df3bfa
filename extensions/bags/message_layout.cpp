#include "extensions/bags/message_layout.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

namespace joulepath {
namespace {

constexpr int kMostDepth = 16;
constexpr std::size_t kMostFields = 4096;
constexpr std::size_t kMostElements = 1u << 24;

constexpr std::array<std::pair<std::string_view, FieldKind>, 15> kKinds{{{"bool", FieldKind::uint8},
                                                                         {"byte", FieldKind::uint8},
                                                                         {"char", FieldKind::uint8},
                                                                         {"int8", FieldKind::int8},
                                                                         {"uint8", FieldKind::uint8},
                                                                         {"int16", FieldKind::int16},
                                                                         {"uint16", FieldKind::uint16},
                                                                         {"int32", FieldKind::int32},
                                                                         {"uint32", FieldKind::uint32},
                                                                         {"int64", FieldKind::int64},
                                                                         {"uint64", FieldKind::uint64},
                                                                         {"float32", FieldKind::float32},
                                                                         {"float64", FieldKind::float64},
                                                                         {"string", FieldKind::text},
                                                                         {"float", FieldKind::float32}}};

std::string_view word(std::string_view& line) {
  const auto first = line.find_first_not_of(" \t\r");
  line.remove_prefix(first == std::string_view::npos ? line.size() : first);
  const auto end = std::min(line.find_first_of(" \t\r"), line.size());
  const std::string_view found = line.substr(0, end);
  line.remove_prefix(end);
  return found;
}

/// `package/msg/Type` and `package/Type` are the same.
std::string short_name(std::string_view type) {
  const auto first = type.find('/'), last = type.rfind('/');
  if (first == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, first)) + std::string(type.substr(last));
}

class LayoutReader {
 public:
  LayoutReader(const std::string& type, std::string_view definition) : top_(short_name(type)) {
    std::string current = top_;
    while (!definition.empty()) {
      const auto end = std::min(definition.find('\n'), definition.size());
      std::string_view line = definition.substr(0, end);
      definition.remove_prefix(std::min(end + 1, definition.size()));
      if (line.substr(0, 3) == "===") continue;
      std::string_view rest = line;
      if (word(rest) == "MSG:")
        current = short_name(word(rest));
      else
        lines_[current].push_back(line);
    }
  }

  std::shared_ptr<const MessageLayout> read() { return layout(top_, 0); }

 private:
  std::shared_ptr<const MessageLayout> layout(const std::string& type, int depth) {
    if (const auto known = known_.find(type); known != known_.end()) return known->second;
    const auto lines = lines_.find(type);
    if (lines == lines_.end() || depth > kMostDepth) return nullptr;
    auto result = std::make_shared<MessageLayout>();
    for (const std::string_view line : lines->second) {
      std::optional<MessageField> field = read_field(line, type, depth);
      if (!good_ || ++fields_ > kMostFields) return nullptr;
      if (field) result->fields.push_back(std::move(*field));
    }
    known_[type] = result;
    return result;
  }

  /// A line `type name`; empty for a comment or a constant.
  std::optional<MessageField> read_field(std::string_view line, const std::string& inside, int depth) {
    line = line.substr(0, line.find('#'));
    std::string_view type = word(line), name = word(line);
    if (type.empty()) return {};
    const auto equals = line.find_first_not_of(" \t\r");
    if (name.find('=') != std::string_view::npos || (equals != std::string_view::npos && line[equals] == '='))
      return {};
    MessageField field{.name = std::string(name)};
    if (const auto open = type.find('['); open != std::string_view::npos) {
      read_shape(type.substr(open + 1), field);
      type = type.substr(0, open);
    }
    type = type.substr(0, type.find("<="));
    const auto* kind =
        std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& k) { return k.first == type; });
    if (kind != kKinds.end()) {
      field.kind = kind->second;
      return field;
    }
    field.kind = FieldKind::message;
    field.message = layout(full_name(type, inside), depth + 1);
    good_ = good_ && field.message && !field.name.empty();
    return field;
  }

  static void read_shape(std::string_view text, MessageField& field) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), field.count);
    const bool fixed = error == std::errc{} && field.count <= kMostElements;
    field.shape = fixed ? MessageField::Shape::fixed : MessageField::Shape::sequence;
    if (!fixed) field.count = 0;
  }

  /// A type without a package belongs to the same package; `Header` belongs to std_msgs.
  [[nodiscard]] std::string full_name(std::string_view type, const std::string& inside) const {
    if (type.find('/') != std::string_view::npos) return short_name(type);
    const std::string same = inside.substr(0, inside.find('/')) + "/" + std::string(type);
    if (type == "Header" && !lines_.contains(same)) return "std_msgs/Header";
    const std::string builtin = "builtin_interfaces/";
    if (type == "time" || type == "Time") return lines_.contains(same) ? same : builtin + "Time";
    return same;
  }

  std::string top_;
  std::map<std::string, std::vector<std::string_view>> lines_{};
  std::map<std::string, std::shared_ptr<const MessageLayout>> known_{};
  std::size_t fields_{};
  bool good_{true};
};

}  // namespace

std::size_t size_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::int8:
    case FieldKind::uint8:
      return 1;
    case FieldKind::int16:
    case FieldKind::uint16:
      return 2;
    case FieldKind::int64:
    case FieldKind::uint64:
    case FieldKind::float64:
      return 8;
    default:
      return 4;
  }
}

std::shared_ptr<const MessageLayout> layout_of(const std::string& type, std::string_view definition) {
  return LayoutReader(type, definition).read();
}

}  // namespace joulepath
