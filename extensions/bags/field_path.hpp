#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace joulepath {

/// One step of a path to a number in a message: a field, and its element if it is an array.
struct FieldStep {
  std::string field{};
  std::optional<std::string> element{};  ///< an index, or the name of the element
};

/// `twist.twist.linear.x`, `velocity[0]`, `effort[left_wheel]`, `status[battery].values[voltage].value`.
/// Empty if the text is not a path.
[[nodiscard]] std::vector<FieldStep> field_path(std::string_view text);

/// The index of an element; empty for a name.
[[nodiscard]] std::optional<std::size_t> element_index(const std::string& element);

/// Fields of an array's elements that hold the name of the element.
[[nodiscard]] bool names_element(std::string_view field);

/// The field beside an array of numbers that holds the names of its elements.
inline constexpr std::string_view kElementNames = "name";

/// A number in a text, NaN if there is none.
[[nodiscard]] double number_in(std::string_view text);

}  // namespace joulepath
