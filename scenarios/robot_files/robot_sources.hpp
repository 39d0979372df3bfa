#pragma once

#include "scenarios/registry.hpp"
#include "scenarios/robot_files/robot_draft.hpp"

namespace joulepath {

/// The reader of a file by its first characters, or by its content; null: the file is no such source.
[[nodiscard]] const RobotSource* robot_source_of(const std::string& file);
[[nodiscard]] const RobotSource* robot_source_of(const Document& document);

/// The kinds of files that say something about a robot, in words.
[[nodiscard]] std::string robot_source_names();

/// What files of other programs, or data sheets, say about a robot together. `wheels`: the joints of the left
/// and of the right drive wheel; empty: the files say which. Throws ConfigError.
[[nodiscard]] RobotDraft draft_from(const std::vector<std::string>& files,
                                    const std::vector<std::string>& wheels);

}  // namespace joulepath
