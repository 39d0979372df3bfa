#include <cmath>
#include <limits>
#include <optional>

#include "extensions/bags/byte_cursor.hpp"
#include "extensions/bags/field_path.hpp"
#include "extensions/bags/message_layout.hpp"
#include "extensions/bags/message_numbers.hpp"
#include "extensions/bags/ros_definitions.hpp"

// OMG DDSI-RTPS 2.5, 10 (plain CDR, version 1): alignment counts from the end of the 4 bytes of the
// encapsulation.
namespace joulepath {
namespace {

constexpr std::size_t kOrigin = 4;
constexpr int kNoSlot = -1;

struct Wanted;

/// A requested element of an array.
struct WantedElement {
  std::string name{};
  std::optional<std::size_t> index{};
  int slot{kNoSlot};
  std::unique_ptr<Wanted> below{};
};

struct WantedField {
  int slot{kNoSlot};
  std::unique_ptr<Wanted> below{};
  std::vector<WantedElement> elements{};
};

/// The requested values of a message: one entry per field of its layout.
struct Wanted {
  explicit Wanted(const MessageLayout& layout) : fields(layout.fields.size()) {}
  std::vector<WantedField> fields;
};

double number_of(ByteCursor& in, FieldKind kind) {
  switch (kind) {
    case FieldKind::int8:
      return in.number<std::int8_t>();
    case FieldKind::uint8:
      return in.number<std::uint8_t>();
    case FieldKind::int16:
      return in.number<std::int16_t>();
    case FieldKind::uint16:
      return in.number<std::uint16_t>();
    case FieldKind::int32:
      return in.number<std::int32_t>();
    case FieldKind::uint32:
      return in.number<std::uint32_t>();
    case FieldKind::int64:
      return static_cast<double>(in.number<std::int64_t>());
    case FieldKind::uint64:
      return static_cast<double>(in.number<std::uint64_t>());
    case FieldKind::float32:
      return in.number<float>();
    default:
      return in.number<double>();
  }
}

class CdrNumbers : public MessageNumbers {
 public:
  explicit CdrNumbers(std::shared_ptr<const MessageLayout> layout)
      : layout_(std::move(layout)), wanted_(*layout_) {}

  bool has(const std::string& path) const override {
    const MessageLayout* layout = layout_.get();
    const auto steps = field_path(path);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const MessageField* field = layout ? find(*layout, steps[i]) : nullptr;
      if (!field) return false;
      layout = field->message.get();
    }
    return !steps.empty() && !layout;
  }

  void want(const std::string& path) override {
    const int slot = slots_++;
    if (!has(path)) return;
    const MessageLayout* layout = layout_.get();
    Wanted* at = &wanted_;
    const auto steps = field_path(path);
    for (const FieldStep& step : steps) {
      const MessageField* field = find(*layout, step);
      WantedField& wanted = at->fields[static_cast<std::size_t>(field - layout->fields.data())];
      std::unique_ptr<Wanted>* below = &wanted.below;
      int* number = &wanted.slot;
      if (step.element) {
        wanted.elements.push_back({.name = *step.element, .index = element_index(*step.element)});
        below = &wanted.elements.back().below;
        number = &wanted.elements.back().slot;
      }
      if (&step == &steps.back()) {
        *number = slot;
        return;
      }
      layout = field->message.get();
      if (!*below) *below = std::make_unique<Wanted>(*layout);
      at = below->get();
    }
  }

  void read(std::string_view data, std::vector<double>& values) override {
    values.assign(static_cast<std::size_t>(slots_), std::numeric_limits<double>::quiet_NaN());
    values_ = &values;
    ByteCursor in = body(data);
    message(in, *layout_, &wanted_, nullptr);
  }

  std::vector<std::string> element_names(std::string_view data) override {
    std::vector<std::string> names;
    std::vector<double> ignored(static_cast<std::size_t>(slots_));
    values_ = &ignored;
    ByteCursor in = body(data);
    message(in, *layout_, nullptr, nullptr);
    values_ = nullptr;
    for (const std::string_view name : names_) names.emplace_back(name);
    return names;
  }

 private:
  static ByteCursor body(std::string_view data) {
    ByteCursor in(data);
    const std::string_view head = in.take(kOrigin);
    if (head[0] != 0 || head[1] != 1) throw BytesEnd();  // CDR, little-endian
    return in;
  }

  static const MessageField* find(const MessageLayout& layout, const FieldStep& step) {
    for (const MessageField& field : layout.fields)
      if (field.name == step.field)
        return step.element.has_value() == (field.shape != MessageField::Shape::one) ? &field : nullptr;
    return nullptr;
  }

  void put(int slot, double value) {
    if (slot != kNoSlot) (*values_)[static_cast<std::size_t>(slot)] = value;
  }

  /// `name` becomes the text that names this element of an array.
  void message(ByteCursor& in, const MessageLayout& layout, const Wanted* wanted, std::string_view* name) {
    if (layout.fields.empty()) in.take(1);
    for (std::size_t i = 0; i < layout.fields.size(); ++i) {
      const MessageField& field = layout.fields[i];
      const WantedField* of_field = wanted ? &wanted->fields[i] : nullptr;
      if (field.shape == MessageField::Shape::one)
        one(in, field, of_field, names_element(field.name) ? name : nullptr);
      else
        many(in, field, of_field);
    }
  }

  void one(ByteCursor& in, const MessageField& field, const WantedField* wanted, std::string_view* name) {
    if (field.kind == FieldKind::message) {
      message(in, *field.message, wanted ? wanted->below.get() : nullptr, nullptr);
    } else if (field.kind == FieldKind::text) {
      const std::string_view text = read_text(in);
      if (name) *name = text;
      if (wanted && wanted->slot != kNoSlot) put(wanted->slot, number_in(text));
    } else {
      in.align(size_of(field.kind), kOrigin);
      if (wanted && wanted->slot != kNoSlot)
        put(wanted->slot, number_of(in, field.kind));
      else
        in.take(size_of(field.kind));
    }
  }

  void many(ByteCursor& in, const MessageField& field, const WantedField* wanted) {
    std::size_t count = field.count;
    if (field.shape == MessageField::Shape::sequence) {
      in.align(4, kOrigin);
      count = in.number<std::uint32_t>();
    }
    if (field.kind == FieldKind::message)
      messages(in, field, wanted, count);
    else if (field.kind == FieldKind::text)
      texts(in, field, count);
    else
      numbers(in, field, wanted, count);
  }

  void texts(ByteCursor& in, const MessageField& field, std::size_t count) {
    const bool keep = field.name == kElementNames;
    if (keep) names_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string_view text = read_text(in);
      if (keep) names_.push_back(text);
    }
  }

  void numbers(ByteCursor& in, const MessageField& field, const WantedField* wanted, std::size_t count) {
    if (count == 0) return;
    const std::size_t size = size_of(field.kind);
    in.align(size, kOrigin);
    if (count > in.left() / size) throw BytesEnd();
    const std::string_view bytes = in.take(count * size);
    if (!wanted) return;
    for (const WantedElement& element : wanted->elements) {
      std::size_t index = element.index.value_or(count);
      for (std::size_t i = 0; !element.index && i < names_.size(); ++i)
        if (names_[i] == element.name) index = i;
      if (index >= count) continue;
      ByteCursor at(bytes.substr(index * size, size));
      put(element.slot, number_of(at, field.kind));
    }
  }

  void messages(ByteCursor& in, const MessageField& field, const WantedField* wanted, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const ByteCursor begin = in;
      std::string_view name;
      const std::size_t before = in.position();
      message(in, *field.message, nullptr, &name);
      if (in.position() == before) throw BytesEnd();  // elements without bytes: the count is invalid
      if (!wanted) continue;
      for (const WantedElement& element : wanted->elements) {
        if (element.index ? *element.index != i : element.name != name) continue;
        ByteCursor again = begin;
        message(again, *field.message, element.below.get(), nullptr);
      }
    }
  }

  static std::string_view read_text(ByteCursor& in) {
    in.align(4, kOrigin);
    std::string_view text = in.text();
    if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    return text;
  }

  std::shared_ptr<const MessageLayout> layout_;
  Wanted wanted_;
  int slots_{};
  std::vector<double>* values_{};
  std::vector<std::string_view> names_{};
};

}  // namespace

std::unique_ptr<MessageNumbers> cdr_numbers(const MessageChannel& channel) {
  const bool defined = channel.schema_encoding == "ros2msg" && !channel.schema.empty();
  const std::string definition = defined ? channel.schema : ros_definition(channel.type);
  auto layout = layout_of(channel.type, definition);
  return layout ? std::make_unique<CdrNumbers>(std::move(layout)) : nullptr;
}

}  // namespace joulepath
