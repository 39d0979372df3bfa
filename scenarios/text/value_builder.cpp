#include "scenarios/text/value_builder.hpp"

#include "model/printable.hpp"
// Design: docs/decisions/0600-input-files.md

namespace joulepath {
namespace {

std::size_t values_in(const Value& value) {
  std::size_t count = 1;
  for (const Value& item : value.items) count += values_in(item);
  for (const Value::Entry& entry : value.entries) count += values_in(entry.value);
  return count;
}

}  // namespace

void ValueBuilder::fail(Place place, std::string key, std::string found, std::string accepted,
                        std::string hint) const {
  throw ConfigError({{std::string(file_), place.line, place.column},
                     std::move(key),
                     std::move(found),
                     std::move(accepted),
                     std::move(hint)});
}

bool ValueBuilder::wants_key() const {
  return !open_.empty() && open_.back().value->kind == Value::Kind::map && !open_.back().has_key;
}

std::string ValueBuilder::path() const {
  std::string path;
  for (const Frame& frame : open_) {
    const Value& value = *frame.value;
    if (value.kind == Value::Kind::map && !value.entries.empty())
      path = path_of_key(path, value.entries.back().key, style_);
    else if (value.kind == Value::Kind::list && !value.items.empty())
      path = path_of_item(path, value.items.size() - 1, style_);
  }
  return path;
}

void ValueBuilder::count(std::size_t values, Place place) {
  count_ += values;
  if (count_ > kMaxValues) fail(place, "", "more than 2,000,000 values", "a smaller file");
}

/// A line break or a mark that turns the direction of writing would forge a line wherever the text is
/// printed.
void ValueBuilder::take_text(std::string& text, Place place) const {
  if (const std::string control = first_control_character(text); !control.empty())
    fail(place, path(), "the control character " + control, "text without control characters");
  text = printable(text);
}

Value& ValueBuilder::place_for(Place place) {
  count(1, place);
  if (open_.empty()) return root_;
  Frame& frame = open_.back();
  if (frame.value->kind == Value::Kind::list) return frame.value->items.emplace_back();
  if (!frame.has_key) fail(place, "", "a key that is a list or a map", "a word as key");
  frame.has_key = false;
  return frame.value->entries.back().value;
}

void ValueBuilder::open(Value::Kind kind, Place place) {
  Value& value = place_for(place);
  if (open_.size() > kMaxDepth) fail(place, "", "lists and maps more than 64 deep", "a smaller file");
  value.kind = kind;
  value.line = place.line;
  value.column = place.column;
  open_.push_back({.value = &value});
}

void ValueBuilder::close() {
  last_ = open_.back().value;
  open_.pop_back();
}

void ValueBuilder::key(std::string text, Place place) {
  Frame& frame = open_.back();
  take_text(text, place);
  const auto [same, is_new] = frame.line_of_key.emplace(text, place.line);
  frame.value->entries.push_back({.key = std::move(text), .line = place.line, .column = place.column});
  if (!is_new)
    fail(place, path(), "a duplicate key", "each key once",
         "the first one is on line " + std::to_string(same->second));
  frame.has_key = true;
}

void ValueBuilder::scalar(std::string text, bool quoted, Place place) {
  if (wants_key()) return key(std::move(text), place);
  Value& value = place_for(place);
  value.kind = Value::Kind::scalar;
  value.text = std::move(text);
  value.quoted = quoted;
  value.line = place.line;
  value.column = place.column;
  last_ = &value;
  take_text(value.text, place);
}

void ValueBuilder::null(Place place) {
  Value& value = place_for(place);
  const bool in_map = !open_.empty() && open_.back().value->kind == Value::Kind::map;
  value.line = in_map ? open_.back().value->entries.back().line : place.line;
  value.column = in_map ? open_.back().value->entries.back().column : place.column;
  last_ = &value;
}

void ValueBuilder::count_copy(const Value& value, Place place) { count(values_in(value), place); }

void ValueBuilder::copy(const Value& value, Place place) {
  if (wants_key() && value.kind == Value::Kind::scalar) return key(value.text, place);
  count_copy(value, place);
  Value& made = place_for(place);
  made = value;
  last_ = &made;
}

}  // namespace joulepath
