#pragma once

#include <string_view>

#include "model/config_error.hpp"

namespace joulepath::python {

/// Calls a function that reads what was made from Python objects: a text, a frame. Errors name the key only,
/// because the user does not know the lines of that text. `is_object`: whether a name is of such an object.
template <class IsObject, class Function>
auto from_objects(IsObject&& is_object, Function&& function) {
  try {
    return function();
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    if (is_object(detail.mark.file)) detail.mark.line = detail.mark.column = 0;
    throw ConfigError(detail);
  }
}

template <class Function>
auto from_object(std::string_view name, Function&& function) {
  return from_objects([&](const std::string& file) { return file == name; }, function);
}

}  // namespace joulepath::python
