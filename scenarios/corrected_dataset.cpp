#include "scenarios/corrected_dataset.hpp"

#include <charconv>
#include <filesystem>

#include "model/effects/catalog.hpp"
#include "scenarios/document.hpp"
#include "scenarios/log_columns.hpp"
#include "scenarios/quoted.hpp"
#include "scenarios/significant.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

/// A value in YAML's flow style.
std::string flow_text(const Value& value) {
  std::string text;
  switch (value.kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::scalar: {
      const bool word = value.text == "true" || value.text == "false";
      return !value.quoted && (word || parse_number(value.text)) ? value.text : quoted(value.text);
    }
    case Value::Kind::list:
      for (const Value& item : value.items) text += (text.empty() ? "" : ", ") + flow_text(item);
      return "[" + text + "]";
    case Value::Kind::map:
      for (const Value::Entry& entry : value.entries)
        text += (text.empty() ? "" : ", ") + entry.key + ": " + flow_text(entry.value);
      return "{" + text + "}";
  }
  return text;
}

/// Names of files, relative to the dataset's folder, become relative to another one.
class Relocation {
 public:
  Relocation(const std::string& dataset_file, const std::string& directory)
      : from_(fs::absolute(dataset_file).parent_path()), to_(fs::absolute(directory)) {}

  void move(Value& name) const {
    for (Value& item : name.items) move(item);
    if (name.kind != Value::Kind::scalar || name.text.starts_with("$") || fs::path(name.text).is_absolute())
      return;
    name.text = (from_ / name.text).lexically_normal().lexically_proximate(to_.lexically_normal()).string();
    name.quoted = true;
  }

 private:
  fs::path from_, to_;
};

/// What the instruments did to a current and its time stamps.
struct Distortion {
  double gain{1.0};
  double offset_A{};
  double delay_s{};
};

Distortion distortion_of(const std::vector<EffectSetting>& instruments, Side side) {
  Distortion distortion;
  const auto add = [&](const auto& effect) {
    if constexpr (requires { effect.current_reading(side); }) {
      const CurrentReading reading = effect.current_reading(side);
      distortion.offset_A += reading.offset_A;
      distortion.gain *= reading.gain;
    }
    if constexpr (requires { effect.channel_delay_s(); }) distortion.delay_s += effect.channel_delay_s();
  };
  for (const EffectSetting& setting : instruments) std::visit(add, make_effect(setting));
  return distortion;
}

/// A column's mapping with the distortion undone: value = ((scale x + offset) - offset_A) / gain, read later.
ColumnSource undone(ColumnSource source, const Distortion& distortion, bool is_current) {
  if (is_current) {
    source.scale /= distortion.gain;
    source.offset = (source.offset - (source.is_unsigned ? 0.0 : distortion.offset_A)) / distortion.gain;
  }
  source.delay_s += distortion.delay_s;
  return source;
}

/// Shortest text that reads back as the same number: a scale is not to be rounded.
std::string exact_text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string source_text(const std::string& column, const ColumnSource& source) {
  std::string names;
  for (const std::string& name : source.from) names += (names.empty() ? "" : ", ") + quoted(name);
  std::string text = "{from: " + (source.from.empty()       ? quoted(column)
                                  : source.from.size() == 1 ? names
                                                            : "[" + names + "]");
  if (source.scale != 1) text += ", scale: " + exact_text(source.scale);
  if (source.offset != 0) text += ", offset: " + exact_text(source.offset);
  if (source.is_unsigned) text += ", unsigned: true";
  if (source.wraps_at) text += ", wraps_at: " + exact_text(*source.wraps_at);
  if (source.derivative) text += ", derivative: true";
  if (source.delay_s != 0) text += ", delay_s: " + exact_text(source.delay_s);
  return text + "}";
}

bool is_logged(const Dataset& dataset, const std::string& column) {
  const LogColumn* known = find_log_column(column);
  for (const Run& run : dataset.runs) {
    Trajectory log = run.log;
    if (known && !known->channel(log).empty()) return true;
  }
  return false;
}

ColumnSources corrected_sources(const Dataset& dataset, ColumnSources sources,
                                const std::vector<EffectSetting>& instruments) {
  for (Side side : kSides) {
    const Distortion distortion = distortion_of(instruments, side);
    for (const char* channel : {"current", "voltage", "power"}) {
      const bool is_current = channel == std::string("current");
      const std::string unit = is_current ? "_A" : channel == std::string("voltage") ? "_V" : "_W";
      const std::string column = std::string("motor_") + channel + "_" + side_name(side) + unit;
      if (!is_logged(dataset, column) || (!is_current && distortion.delay_s == 0)) continue;
      sources[column] = undone(sources[column], distortion, is_current);
    }
  }
  return sources;
}

std::string comment_on(const EffectSetting& effect) {
  std::string text = "#   " + effect.name;
  if (effect.side) text += std::string(" ") + side_name(*effect.side);
  for (const auto& [key, value] : effect.parameters) text += " " + key + " = " + significant_text(value);
  return text + "\n";
}

void relocate_run(Value& run, const Relocation& relocation) {
  for (Value::Entry& entry : run.entries)
    if (entry.key == "file" || entry.key == "files" || entry.key == "predicted") relocation.move(entry.value);
}

}  // namespace

std::string corrected_dataset_text(const Dataset& dataset, const std::vector<EffectSetting>& instruments,
                                   const std::string& directory) {
  const Document document = Document::load(dataset.file);
  const auto columns = document.root().find("columns");
  const ColumnSources sources =
      corrected_sources(dataset, columns ? read_column_sources(*columns) : ColumnSources{}, instruments);
  std::string text =
      "schema: joulepath/dataset/1\n# Readings as they would be without the instruments' errors:\n";
  for (const EffectSetting& effect : instruments) text += comment_on(effect);
  const Relocation relocation(dataset.file, directory);
  const fs::path robot = fs::absolute(dataset.robot_file)
                             .lexically_normal()
                             .lexically_proximate(fs::absolute(directory).lexically_normal());
  text += "robot: " + quoted(robot.string()) + "\ncolumns:\n";
  for (const auto& [column, source] : sources)
    text += "  " + column + ": " + source_text(column, source) + "\n";
  text += "runs:\n";
  for (const Node& run : document.root()["runs"].items()) {
    Value value = run.value();
    relocate_run(value, relocation);
    text += "  - " + flow_text(value) + "\n";
  }
  return text;
}

}  // namespace joulepath
