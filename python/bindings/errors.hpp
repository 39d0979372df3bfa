#pragma once

#include <string_view>

#include "model/config_error.hpp"

namespace joulepath::python {

/// Calls a function that reads a text made from a Python object. Errors name the key only, because the user
/// does not know the lines of that text.
template <class Function>
auto from_object(std::string_view name, Function&& function) {
  try {
    return function();
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    if (detail.mark.file == name) detail.mark.line = detail.mark.column = 0;
    throw ConfigError(detail);
  }
}

}  // namespace joulepath::python
