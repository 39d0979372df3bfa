#pragma once

#include <string>
#include <vector>

#include "extensions/bags/bag_file.hpp"
#include "scenarios/log_files/log_columns.hpp"

namespace joulepath {

/// The messages beside the motion of an exported log or plan: JSON with the columns of logs.
inline constexpr const char* kPowerType = "joulepath/power/1";

/// A topic of a bag and its possible columns of a run.
struct BagTopic {
  MessageChannel channel{};
  std::size_t messages{};
  bool readable{};                      ///< its encoding and its definition are known
  std::vector<std::string> elements{};  ///< names beside its arrays (joints)
  std::string first{};                  ///< its first message, if it is JSON
};

struct BagSurvey {
  std::vector<BagTopic> topics{};
  MessageDamage damage{};
  double begins_s{};    ///< stamp of the first message
  double duration_s{};  ///< between the first and the last log time
};

/// The topics of a bag.
[[nodiscard]] BagSurvey survey_bag(const std::string& file, const NamedBy& named_by = {});

/// The columns that the types of a bag's topics suggest: speeds of the first Odometry, the pose of a
/// localization or else of the odometry, wheels of the first JointState whose joints are called left and
/// right, battery, gyro and commands. Currents are not among them: an effort may be a torque. Power messages
/// suggest all of their columns.
[[nodiscard]] ColumnSources suggested_columns(const BagSurvey& survey);

/// A dataset file for a bag, with those suggested columns that its messages have, for the user to confirm. It
/// names the bag as given.
[[nodiscard]] std::string suggested_dataset(const BagSurvey& survey, const std::string& file);

/// The topic and the field path of a column's `from`, `/odom.twist.twist.linear.x`; false if no topic
/// matches.
[[nodiscard]] bool split_source(const std::string& from, const std::string& topic, std::string& path);

}  // namespace joulepath
