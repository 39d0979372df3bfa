#include <limits>

#include "extensions/bags/byte_cursor.hpp"
#include "extensions/bags/field_path.hpp"
#include "extensions/bags/message_numbers.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath {
namespace {

using nlohmann::json;

/// The element of an array for a step: by index, by the names beside it, or by a name inside.
const json* element_of(const json& array, const json& beside, const std::string& element) {
  if (const auto index = element_index(element)) return *index < array.size() ? &array[*index] : nullptr;
  const auto names = beside.find(kElementNames);
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (names != beside.end() && names->is_array() && i < names->size() && (*names)[i] == element)
      return &array[i];
    if (!array[i].is_object()) continue;
    for (const auto& [key, value] : array[i].items())
      if (names_element(key) && value == element) return &array[i];
  }
  return nullptr;
}

double value_at(const json& message, const std::vector<FieldStep>& path) {
  const json* at = &message;
  for (const FieldStep& step : path) {
    if (!at->is_object()) return std::numeric_limits<double>::quiet_NaN();
    const auto found = at->find(step.field);
    if (found == at->end()) return std::numeric_limits<double>::quiet_NaN();
    const json* next = &*found;
    if (step.element) next = next->is_array() ? element_of(*next, *at, *step.element) : nullptr;
    if (!next) return std::numeric_limits<double>::quiet_NaN();
    at = next;
  }
  if (at->is_number()) return at->get<double>();
  if (at->is_boolean()) return at->get<bool>() ? 1.0 : 0.0;
  return at->is_string() ? number_in(at->get_ref<const std::string&>())
                         : std::numeric_limits<double>::quiet_NaN();
}

json parsed(std::string_view data) {
  json message = shallow_json(data);
  if (message.is_discarded()) throw BytesEnd();
  return message;
}

/// JSON messages have no definition in advance, so any path is accepted.
class JsonNumbers : public MessageNumbers {
 public:
  bool has(const std::string& path) const override { return !field_path(path).empty(); }
  void want(const std::string& path) override { paths_.push_back(field_path(path)); }

  void read(std::string_view data, std::vector<double>& values) override {
    const json message = parsed(data);
    values.clear();
    for (const auto& path : paths_) values.push_back(value_at(message, path));
  }

  std::vector<std::string> element_names(std::string_view data) override {
    const json message = parsed(data);
    std::vector<std::string> names;
    if (!message.is_object()) return names;
    const auto found = message.find(kElementNames);
    if (found != message.end() && found->is_array())
      for (const json& name : *found)
        if (name.is_string()) names.push_back(name.get<std::string>());
    return names;
  }

 private:
  std::vector<std::vector<FieldStep>> paths_{};
};

}  // namespace

std::unique_ptr<MessageNumbers> json_numbers() { return std::make_unique<JsonNumbers>(); }

std::unique_ptr<MessageNumbers> message_numbers(const MessageChannel& channel) {
  if (channel.encoding == "json") return json_numbers();
  return channel.encoding == "cdr" ? cdr_numbers(channel) : nullptr;
}

}  // namespace joulepath
