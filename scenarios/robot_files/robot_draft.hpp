#pragma once

#include <string>
#include <vector>

namespace joulepath {

/// A value of a robot file and where it comes from.
struct DraftValue {
  std::string key{};  ///< dotted, as in the robot file; `effects`: an item of the list
  std::string text{};
  std::string origin{};  ///< "waffle.urdf line 12: mass of base_link"
};

/// What another program's file says about a robot.
struct RobotDraft {
  std::string name{};
  std::vector<DraftValue> values{};
  std::vector<std::string> notes{};  ///< what was not read, or contradicts itself

  void state(const std::string& key, double value, const std::string& origin);
  /// The value of each side; one number where both agree.
  void state(const std::string& key, double left, double right, const std::string& origin);
};

/// Adds what a further file says. The first value of a key counts; another one is told in its origin.
void add_draft(RobotDraft& draft, const RobotDraft& more);

/// The text of a robot file: a comment with its origin beside each value, and a line `# missing: KEY` for
/// each required one that no source states.
[[nodiscard]] std::string draft_text(const RobotDraft& draft);

/// The required keys that a draft lacks.
[[nodiscard]] std::vector<std::string> missing_in(const RobotDraft& draft);

}  // namespace joulepath
