#pragma once

#include <string>

#include "model/robot.hpp"
#include "scenarios/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema robot_schema();

/// Reads a robot file. Throws ConfigError; `named_by` is where another file names this one.
[[nodiscard]] Robot read_robot(const std::string& file, const NamedBy& named_by = {});

/// The robot that a parsed document describes.
[[nodiscard]] Robot robot_from(const Document& document);

/// A robot as a file that reads back as the same robot (numbers to the last bit).
[[nodiscard]] std::string robot_text(const Robot& robot);

}  // namespace joulepath
