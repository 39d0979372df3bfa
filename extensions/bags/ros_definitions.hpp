#pragma once

#include <string>

namespace joulepath {

/// The definition of a message type that is written, or that may occur in a bag without definitions, with
/// those of the types that it uses (schema encoding ros2msg); empty for any other type.
[[nodiscard]] std::string ros_definition(const std::string& type);

}  // namespace joulepath
