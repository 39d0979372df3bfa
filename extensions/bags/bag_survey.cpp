#include "extensions/bags/bag_survey.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "extensions/bags/byte_cursor.hpp"
#include "extensions/bags/message_numbers.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath {
namespace {

std::string short_type(const BagTopic& topic) {
  const std::string& type = topic.channel.type;
  return type.substr(0, type.find('/')) + type.substr(std::min(type.rfind('/'), type.size()));
}

std::vector<std::string> joints_of(const BagTopic& topic, const std::string& side) {
  std::vector<std::string> joints;
  std::ranges::copy_if(topic.elements, std::back_inserter(joints),
                       [&](const std::string& joint) { return joint.find(side) != std::string::npos; });
  return joints;
}

const MessageReader* reader_of_type(const std::string& type) {
  for (const MessageReader& reader : registry().messages)
    if (reader.type == type) return &reader;
  return nullptr;
}

/// Collects sources; a column keeps its first suggestion.
class Suggestion {
 public:
  explicit Suggestion(const BagSurvey& survey) : survey_(survey) {}

  ColumnSources columns() {
    for (const BagTopic& topic : survey_.topics)
      if (topic.readable && topic.messages > 0) of_topic(topic);
    return std::move(columns_);
  }

 private:
  void add(const std::string& column, const BagTopic& topic, const std::string& path, double scale = 1.0) {
    columns_.try_emplace(column, ColumnSource{.from = {topic.channel.topic + "." + path}, .scale = scale});
  }

  /// Messages of a type that another extension reads.
  void of_reader(const MessageReader& reader, const BagTopic& topic) {
    if (!columns_.empty()) return;  // one robot only
    for (const auto& [column, fields] : reader.columns)
      for (const std::string& field : fields)
        columns_[column].from.push_back(topic.channel.topic + "." + field);
  }

  /// The columns that the schema of power messages names, under their own names.
  void power(const BagTopic& topic) {
    const auto schema = shallow_json(topic.channel.schema);
    if (!schema.is_object() || !schema.contains("properties") || !schema["properties"].is_object()) return;
    for (const auto& [name, value] : schema["properties"].items()) {
      const bool has_heading = name == "heading_rad" && columns_.contains("orientation_w");
      const LogColumn* column = find_log_column(name);  // of a run's log: others only `plan` writes
      if (name != "time_s" && !has_heading && column && column->measured) add(name, topic, name);
    }
  }

  void of_topic(const BagTopic& topic) {
    const std::string type = short_type(topic);
    if (topic.channel.type == kPowerType) {
      power(topic);
    } else if (const MessageReader* reader = reader_of_type(topic.channel.type)) {
      of_reader(*reader, topic);
    } else if (type == "nav_msgs/Odometry") {
      add("linear_speed_m_s", topic, "twist.twist.linear.x");
      add("angular_speed_rad_s", topic, "twist.twist.angular.z");
      if (!has_localization()) pose(topic, "pose.pose.");
    } else if (is_localization(topic)) {
      pose(topic, type == "geometry_msgs/PoseStamped" ? "pose." : "pose.pose.");
    } else if (type == "sensor_msgs/JointState") {
      wheels(topic);
    } else if (type == "sensor_msgs/BatteryState") {
      add("battery_voltage_V", topic, "voltage");
      add("battery_current_A", topic, "current", -1.0);
    } else if (type == "sensor_msgs/Imu") {
      add("gyro_yaw_rate_rad_s", topic, "angular_velocity.z");
    } else if (type == "geometry_msgs/Twist" || type == "geometry_msgs/TwistStamped") {
      const std::string twist = type == "geometry_msgs/Twist" ? "" : "twist.";
      add("command_linear_speed_m_s", topic, twist + "linear.x");
      add("command_angular_speed_rad_s", topic, twist + "angular.z");
    }
  }

  /// Poses of a localization or of motion capture, which do not come from the wheels; a goal or a first guess
  /// has few messages.
  static bool is_localization(const BagTopic& topic) {
    constexpr std::size_t kFew = 10;
    const std::string type = short_type(topic);
    return topic.readable && topic.messages > kFew &&
           (type == "geometry_msgs/PoseWithCovarianceStamped" || type == "geometry_msgs/PoseStamped");
  }

  [[nodiscard]] bool has_localization() const { return std::ranges::any_of(survey_.topics, is_localization); }

  void pose(const BagTopic& topic, const std::string& at) {
    add("position_x_m", topic, at + "position.x");
    add("position_y_m", topic, at + "position.y");
    for (const char* part : {"w", "x", "y", "z"})
      add(std::string("orientation_") + part, topic, at + "orientation." + part);
  }

  /// The only joints whose names contain a side; both or none.
  void wheels(const BagTopic& topic) {
    const std::vector<std::string> left = joints_of(topic, "left"), right = joints_of(topic, "right");
    if (left.size() != 1 || right.size() != 1) return;
    add("wheel_speed_left_rad_s", topic, "velocity[" + left.front() + "]");
    add("wheel_speed_right_rad_s", topic, "velocity[" + right.front() + "]");
  }

  const BagSurvey& survey_;
  ColumnSources columns_{};
};

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) result += c;
  }
  return result + "\"";
}

bool is_of_odometry(const std::string& source, const BagSurvey& survey) {
  std::string path;
  return std::ranges::any_of(survey.topics, [&](const BagTopic& topic) {
    return short_type(topic) == "nav_msgs/Odometry" && split_source(source, topic.channel.topic, path);
  });
}

/// Messages that define themselves have each field of their type; of JSON, the first is looked at.
bool is_in_messages(const ColumnSource& source, const BagSurvey& survey) {
  const auto has = [&](const BagTopic& topic, const std::string& from) {
    std::string path;
    if (!split_source(from, topic.channel.topic, path)) return false;
    if (topic.channel.encoding != "json") return true;
    const auto reader = json_numbers();
    reader->want(path);
    std::vector<double> values;
    try {
      reader->read(topic.first, values);
    } catch (const BytesEnd&) {
      return false;
    }
    return std::isfinite(values.front());
  };
  return std::ranges::any_of(source.from, [&](const std::string& from) {
    return std::ranges::any_of(survey.topics, [&](const BagTopic& topic) { return has(topic, from); });
  });
}

ColumnSources columns_in_messages(const BagSurvey& survey) {
  ColumnSources columns = suggested_columns(survey);
  std::erase_if(columns, [&](const auto& column) { return !is_in_messages(column.second, survey); });
  return columns;
}

/// Currents are not proposed: an effort may be a torque.
std::string currents_in_comments(const BagSurvey& survey) {
  std::string text;
  for (const BagTopic& topic : survey.topics)
    if (short_type(topic) == "sensor_msgs/JointState")
      for (const char* side : {"left", "right"})
        for (const std::string& joint : joints_of(topic, side))
          text += std::string("  # motor_current_") + side +
                  "_A: {from: " + quoted(topic.channel.topic + ".effort[" + joint + "]") +
                  "}  # if effort is a current in A\n";
  return text;
}

std::string from_text(const std::vector<std::string>& sources) {
  const std::string text = text_of_list(sources, quoted);
  return sources.size() == 1 ? text : "[" + text + "]";
}

}  // namespace

BagSurvey survey_bag(const std::string& file, const NamedBy& named_by) {
  BagSurvey survey;
  std::vector<std::unique_ptr<MessageNumbers>> readers;
  std::uint64_t first_ns = ~std::uint64_t{0}, last_ns = 0;
  survey.damage = read_bag(
      file, named_by,
      [&](const MessageChannel& channel) {
        readers.push_back(message_numbers(channel));
        survey.topics.push_back({.channel = channel, .readable = readers.back() != nullptr});
      },
      [&](const TimedMessage& message) {
        BagTopic& topic = survey.topics[message.channel];
        first_ns = std::min(first_ns, message.log_time_ns);
        last_ns = std::max(last_ns, message.log_time_ns);
        if (topic.messages++ == 0 && topic.readable) try {
            if (topic.channel.encoding == "json") topic.first = message.data;
            topic.elements = readers[message.channel]->element_names(message.data);
          } catch (const BytesEnd&) {
          }
      });
  if (last_ns > 0) survey.begins_s = 1e-9 * static_cast<double>(first_ns);
  if (last_ns > first_ns) survey.duration_s = 1e-9 * static_cast<double>(last_ns - first_ns);
  return survey;
}

ColumnSources suggested_columns(const BagSurvey& survey) { return Suggestion(survey).columns(); }

std::string suggested_dataset(const BagSurvey& survey, const std::string& file) {
  std::string text = "schema: joulepath/dataset/1\nrobot: robot.yaml\ncolumns:\n";
  const ColumnSources columns = columns_in_messages(survey);
  if (const auto x = columns.find("position_x_m");
      x != columns.end() && is_of_odometry(x->second.from.front(), survey))
    text +=
        "  # a pose that is computed from the wheels is no measurement: then {absent: true} for\n"
        "  # position_x_m, position_y_m and heading_rad\n";
  for (const LogColumn& known : log_columns())
    if (const auto found = columns.find(known.name); found != columns.end())
      text += "  " + known.name + ": {from: " + from_text(found->second.from) +
              (found->second.scale == 1.0 ? "}\n" : ", scale: -1}  # positive: the battery gives\n");
  for (const char* name : kOrientationColumns)
    if (const auto found = columns.find(name); found != columns.end())
      text += std::string("  ") + name + ": {from: " + quoted(found->second.from.front()) + "}\n";
  text += currents_in_comments(survey);
  text += "  # a line that is removed stays as proposed; {absent: true} leaves its channel out\n";
  text += "runs:\n  - file: " + quoted(file) + "\n";
  if (!columns.contains("payload_kg"))
    text += "    # payload_kg: 0  # state it, in kg; steps: [{from_s: 0, kg: 0}, {from_s: 120, kg: 10}]\n";
  return text;
}

bool split_source(const std::string& from, const std::string& topic, std::string& path) {
  if (from.size() <= topic.size() + 1 || from.rfind(topic, 0) != 0 || from[topic.size()] != '.') return false;
  path = from.substr(topic.size() + 1);
  return true;
}

}  // namespace joulepath
