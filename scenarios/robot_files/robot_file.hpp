#pragma once

#include <string>
#include <vector>

#include "model/robot.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema robot_schema();

/// Dotted keys that every robot file has.
[[nodiscard]] std::vector<std::string> required_robot_keys();

/// Reads a robot file. Throws ConfigError; `named_by` is its place in another file.
[[nodiscard]] Robot read_robot(const std::string& file, const NamedBy& named_by = {});

/// The robot of a parsed document.
[[nodiscard]] Robot robot_from(const Document& document);

/// The text of a robot file that reads back as the same robot (numbers to the last bit).
[[nodiscard]] std::string robot_text(const Robot& robot);

/// The text of a robot's own file with the values of a robot that was fitted or corrected: comments, order
/// and notation stay, changed numbers have six digits. Without a file that can be edited so, robot_text().
[[nodiscard]] std::string robot_text_like(const std::string& file, const Robot& robot);

/// Why the program would refuse a file of the robot: the key, what it would hold and what is accepted. Empty:
/// the file reads back.
[[nodiscard]] std::string refusal_of(const Robot& robot);

}  // namespace joulepath
