#pragma once

#include <optional>
#include <string>
#include <vector>

#include "extensions/studies/sweep/design_table.hpp"
#include "model/robot.hpp"
#include "planner/values/mission_request.hpp"
#include "scenarios/mission_files/mission_list.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// The target of a study's parameter: `robot.motor.gear_ratio`, `mission.legs[*].payload_kg`.
struct StudyTarget {
  bool in_robot{};
  std::string path{};  ///< without the first word
  NamedBy named_by{};
};

/// A bound on a result.
struct StudyConstraint {
  std::string result{};
  std::optional<double> min{};
  std::optional<double> max{};
};

struct StudyObjective {
  std::string result{};  ///< a figure of a result line, or a parameter's name
  bool maximize{};
};

/// Quantities that stay constant while the gear ratio changes.
enum class FrictionHeld { wheel, motor };

/// A study file: its designs, its missions, and its objectives.
struct Study {
  std::string file{};
  std::string text{};  ///< of the file; empty: the study was read from a document
  std::string name{};
  std::vector<std::string> missions{};  ///< files and folders
  std::vector<NamedBy> missions_named_by{};
  std::string robot_file{};  ///< empty: the missions' own
  NamedBy robot_named_by{};
  DesignTable designs{};
  std::vector<StudyTarget> targets{};  ///< one per parameter
  std::vector<StudyConstraint> constraints{};
  std::vector<StudyObjective> objectives{};  ///< --optimize minimizes the first one
  FrictionHeld friction{FrictionHeld::wheel};

  [[nodiscard]] bool changes_gear() const;
};

/// The figures of a result line that a study may use.
[[nodiscard]] const std::vector<std::string>& sweep_results();

[[nodiscard]] Schema study_schema();
[[nodiscard]] Schema sweep_schema();  ///< sweep.json
[[nodiscard]] Schema shard_schema();  ///< shard.json

/// The columns of a row of sweep.csv that are neither a parameter nor a result: before and after the
/// parameters.
inline const std::vector<std::string> kColumnsBefore{"design", "mission"};
inline const std::vector<std::string> kColumnsAfter{"status", "meets_constraints", "reason"};

/// The study of a parsed document; missions and robots are resolved, not read. Throws ConfigError.
[[nodiscard]] Study study_from(const Document& document, const ReadOptions& options = {});

/// Reads a study file once: later changes of the file change nothing. Throws ConfigError.
[[nodiscard]] Study read_study(const std::string& file, const ReadOptions& options = {});

/// All missions of a study, each with a name of its own: that of its file (`line_3` in a list), or the file's
/// path where two have the same name. Throws ConfigError: no missions, or the same mission twice.
[[nodiscard]] std::vector<MissionItem> study_missions(const Study& study);

/// The robot of a design: `robot` with the design's values. Throws ConfigError at the study's parameter.
[[nodiscard]] Robot robot_of_design(const Study& study, const Document& robot,
                                    const std::vector<std::string>& design);

/// The mission of a design: `mission` with the design's values. Throws ConfigError at the study's parameter.
[[nodiscard]] MissionRequest mission_of_design(const Study& study, const Document& mission,
                                               const std::vector<std::string>& design,
                                               const ReadOptions& options = {});

/// Throws ConfigError where the first or the last design of a mission cannot be read, or where a value of one
/// parameter is invalid in itself (of a range: its ends), so that a mistake in the study is reported once and
/// not per design.
void check_designs(const Study& study, const Document& mission, const ReadOptions& options = {});

}  // namespace joulepath
