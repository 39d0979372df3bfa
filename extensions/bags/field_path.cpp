#include "extensions/bags/field_path.hpp"

#include <charconv>
#include <limits>

namespace joulepath {

std::vector<FieldStep> field_path(std::string_view text) {
  std::vector<FieldStep> steps;
  while (!text.empty()) {
    FieldStep step;
    const auto end = std::min(text.find_first_of(".["), text.size());
    step.field = text.substr(0, end);
    if (step.field.empty()) return {};
    text.remove_prefix(end);
    if (!text.empty() && text.front() == '[') {
      const auto close = text.find(']');
      if (close == std::string_view::npos) return {};
      step.element = text.substr(1, close - 1);
      text.remove_prefix(close + 1);
    }
    steps.push_back(std::move(step));
    if (text.empty()) break;
    if (text.front() != '.' || text.size() == 1) return {};
    text.remove_prefix(1);
  }
  return steps;
}

std::optional<std::size_t> element_index(const std::string& element) {
  std::size_t index{};
  const auto [end, error] = std::from_chars(element.data(), element.data() + element.size(), index);
  if (error != std::errc{} || end != element.data() + element.size()) return {};
  return index;
}

bool names_element(std::string_view field) {
  return field == "name" || field == "child_frame_id" || field == "key";
}

double number_in(std::string_view text) {
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace joulepath
