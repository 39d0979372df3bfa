#pragma once

#include <string>

#include "planner/mission/mission.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath::studio {

/// The object that a page sent. Throws ConfigError.
template <class Json>
[[nodiscard]] Json question_from(const std::string& text) {
  Json question = shallow_json<Json>(text);
  if (question.is_object()) return question;
  throw ConfigError({{},
                     "question",
                     "no JSON object, or one that is nested more than 64 deep",
                     "a question of the page",
                     ""});
}

/// The mission and the robot of a question. Throws ConfigError as the readers of their files do. File names
/// are relative to `folder`.
struct Asked {
  MissionRequest mission{};
  Robot robot{};
};
[[nodiscard]] Asked asked_from(const nlohmann::json& question, const std::string& folder);

/// Gives every leg to a station the path of an earlier answer, moved to the present places of its stops.
/// Throws ConfigError where there is none.
void follow_paths(MissionRequest& mission, const nlohmann::json& paths, const Plant& plant);

}  // namespace joulepath::studio
