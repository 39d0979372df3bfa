#include "scenarios/text/text_edit.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/text/json_value.hpp"
#include "scenarios/text/text_spans.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kMostEdits = 4000;

/// Compares values; the order of keys has no meaning.
bool same_values(const Json& a, const Json& b) { return nlohmann::json(a) == nlohmann::json(b); }

/// As the first line of a text ends.
std::string line_break_of(const std::string& text) {
  const std::size_t end = text.find('\n');
  return end != std::string::npos && end > 0 && text[end - 1] == '\r' ? "\r\n" : "\n";
}

/// One step towards the wanted values: the first difference in the order of the file.
class Edit {
 public:
  explicit Edit(const std::string& text) : text_(text), spans_(text_), break_(line_break_of(text)) {}

  /// The text after one edit; absent where this value is already as wanted.
  std::optional<std::string> towards(const Value& value, const Json& wanted, bool in_flow) const {
    const Json now = json_of(value);
    if (same_values(now, wanted)) return std::nullopt;
    const bool inside = in_flow || spans_.is_flow(value);
    if (value.kind == Value::Kind::map && wanted.is_object() && !value.entries.empty())
      return map_towards(value, wanted, inside);
    if (value.kind == Value::Kind::list && wanted.is_array() && !value.items.empty())
      return list_towards(value, wanted, inside);
    return replaced(spans_.of(value, in_flow), flow_text(wanted));
  }

 private:
  std::string replaced(Span span, const std::string& by) const {
    return text_.substr(0, span.begin) + by + text_.substr(span.end);
  }

  std::size_t key_begin(const Value::Entry& entry) const { return spans_.offset(entry.line, entry.column); }

  std::optional<std::string> map_towards(const Value& map, const Json& wanted, bool in_flow) const {
    for (std::size_t k = 0; k < map.entries.size(); ++k) {
      const Value::Entry& entry = map.entries[k];
      if (!wanted.contains(entry.key)) return without_entry(map, k, in_flow);
      if (auto text = towards(entry.value, wanted.at(entry.key), in_flow)) return text;
    }
    for (const auto& [key, value] : wanted.items())
      if (std::none_of(map.entries.begin(), map.entries.end(),
                       [&key = key](const auto& e) { return e.key == key; }))
        return with_entry(map, flow_text(Json{{key, value}}), in_flow);
    return std::nullopt;
  }

  /// `one`: {key: value}.
  std::string with_entry(const Value& map, const std::string& one, bool in_flow) const {
    const std::string entry = one.substr(1, one.size() - 2);
    const std::size_t last = spans_.of(map.entries.back().value, in_flow).end;
    if (in_flow) return replaced({last, last}, ", " + entry);
    const std::size_t first = key_begin(map.entries.front());
    const std::string indent(first - spans_.line_begin(first), ' ');
    return with_line(spans_.line_end(last), indent + entry + break_);
  }

  /// Inserts a line at the beginning of a line, or at the end of a text without a final line break.
  std::string with_line(std::size_t at, const std::string& line) const {
    const bool broken = at == 0 || text_[at - 1] == '\n';
    return replaced({at, at}, (broken ? "" : break_) + line);
  }

  std::string without_entry(const Value& map, std::size_t k, bool in_flow) const {
    if (map.entries.size() == 1) return replaced(spans_.of(map, in_flow), "{}");
    const std::size_t begin = key_begin(map.entries[k]);
    if (k + 1 < map.entries.size() && (in_flow || k == 0))
      return replaced({begin, key_begin(map.entries[k + 1])}, "");
    if (in_flow)
      return replaced(
          {spans_.of(map.entries[k - 1].value, true).end, spans_.of(map.entries[k].value, true).end}, "");
    const std::size_t end = spans_.of(map.entries[k].value, false).end;
    return replaced({spans_.line_begin(begin), spans_.line_end(end)}, "");
  }

  std::optional<std::string> list_towards(const Value& list, const Json& wanted, bool in_flow) const {
    const Json now = json_of(list);
    std::size_t k = 0;
    while (k < now.size() && k < wanted.size() && same_values(now[k], wanted[k])) ++k;
    const auto found = [k](const Json& in, const Json& item) {
      return static_cast<std::size_t>(std::find_if(in.begin() + static_cast<std::ptrdiff_t>(k), in.end(),
                                                   [&](const Json& one) { return same_values(one, item); }) -
                                      in.begin());
    };
    if (k == wanted.size()) return without_item(list, k, in_flow);
    if (k == now.size()) return with_item(list, k, flow_text(wanted[k]), in_flow);
    const std::size_t from = found(now, wanted[k]), to = found(wanted, now[k]);
    if (from < now.size() && to < wanted.size()) return with_moved_item(list, from, k, in_flow);
    if (from < now.size()) return without_item(list, k, in_flow);
    if (to < wanted.size()) return with_item(list, k, flow_text(wanted[k]), in_flow);
    if (now.size() > wanted.size()) return without_item(list, k, in_flow);
    return towards(list.items[k], wanted[k], in_flow);
  }

  /// The lines of an item of a block list, including its dash and the comments beside it.
  Span item_lines(const Value& list, std::size_t k) const {
    const Span item = spans_.of(list.items[k], false);
    return {spans_.line_begin(item.begin), spans_.line_end(item.end)};
  }
  /// The text before an item of a block list: indentation and dash.
  std::string dash(const Value& list) const {
    const std::size_t item = spans_.of(list.items.front(), false).begin;
    const std::size_t begin = text_.rfind('-', item);
    return std::string(begin - spans_.line_begin(begin), ' ') + "- ";
  }

  std::string with_item(const Value& list, std::size_t k, const std::string& item, bool in_flow) const {
    const bool last = k == list.items.size();
    if (in_flow) {
      const Span beside = spans_.of(list.items[last ? k - 1 : k], true);
      return last ? replaced({beside.end, beside.end}, ", " + item)
                  : replaced({beside.begin, beside.begin}, item + ", ");
    }
    const Span lines = item_lines(list, last ? k - 1 : k);
    return with_line(last ? lines.end : lines.begin, dash(list) + item + break_);
  }

  std::string without_item(const Value& list, std::size_t k, bool in_flow) const {
    if (list.items.size() == 1) return replaced(spans_.of(list, in_flow), "[]");
    if (!in_flow) return replaced(item_lines(list, k), "");
    const Span item = spans_.of(list.items[k], true);
    if (k + 1 < list.items.size())
      return replaced({item.begin, spans_.of(list.items[k + 1], true).begin}, "");
    return replaced({spans_.of(list.items[k - 1], true).end, item.end}, "");
  }

  /// Moves an item with its own text to an earlier place.
  std::string with_moved_item(const Value& list, std::size_t from, std::size_t to, bool in_flow) const {
    const Span item = in_flow ? spans_.of(list.items[from], true) : item_lines(list, from);
    const Span place = in_flow ? spans_.of(list.items[to], true) : item_lines(list, to);
    std::string moved = text_.substr(item.begin, item.end - item.begin);
    if (!in_flow && moved.back() != '\n') moved += break_;
    const std::string rest = without_item(list, from, in_flow);
    return rest.substr(0, place.begin) + moved + (in_flow ? ", " : "") + rest.substr(place.begin);
  }

  const std::string& text_;
  TextSpans spans_;
  std::string break_;
};

}  // namespace

std::string with_values(const std::string& text, const std::string& file, const Json& wanted) {
  std::string now = text;
  for (int k = 0; k < kMostEdits; ++k) {
    const Document document = Document::parse(now, file);
    std::optional<std::string> next = Edit(now).towards(document.root().value(), wanted, false);
    if (!next) return now;
    if (*next == now) break;
    now = std::move(*next);
  }
  throw ConfigError({{file, 0, 0},
                     "",
                     "a notation that cannot be edited in place",
                     "values without anchors and without texts over several lines",
                     "the file was not changed"});
}

}  // namespace joulepath
