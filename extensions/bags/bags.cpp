#include <algorithm>
#include <cstdio>

#include "extensions/bags/bag_export.hpp"
#include "extensions/bags/bag_file.hpp"
#include "extensions/bags/bag_log.hpp"
#include "extensions/bags/bag_survey.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/counted.hpp"
// Design: docs/decisions/0602-bags.md

namespace joulepath {
namespace {

FileSummary check_bag(const std::string& file, const ReadOptions&) {
  const BagSurvey survey = survey_bag(file);
  std::size_t messages = 0;
  FileSummary summary{.kind = "bag", .proposes = true};
  for (const BagTopic& topic : survey.topics) {
    messages += topic.messages;
    summary.notes.push_back(topic.channel.topic + ": " + counted(topic.messages, "message") + " of " +
                            topic.channel.type + (topic.readable ? "" : ", cannot be read"));
  }
  if (messages == 0)
    throw ConfigError({{file, 0, 0}, "", no_message_text(survey.damage), "a bag with messages", ""});
  if (survey.damage.truncated) summary.notes.push_back(truncation_text(survey.damage));
  if (survey.damage.broken_chunks > 0)
    summary.notes.push_back(counted(survey.damage.broken_chunks, "broken chunk"));
  if (survey.damage.broken_records > 0)
    summary.notes.push_back(counted(survey.damage.broken_records, "broken record"));
  char duration[32];
  std::snprintf(duration, sizeof duration, "%.1f s", survey.duration_s);
  summary.text = counted(messages, "message") + ", " + duration;
  if (suggested_columns(survey).empty())
    summary.notes.push_back(
        "no topic of a motion is known by its type: a dataset file maps one under columns:");
  else
    summary.proposal = suggested_dataset(survey, file), summary.begins_s = survey.begins_s;
  return summary;
}

}  // namespace

void add_bags(Registry& registry) {
  registry.logs.push_back({"bag", is_bag, read_bag_log});
  registry.files.push_back({.kind = "bag", .recognizes_file = is_bag, .check = check_bag});
  registry.exports.push_back({.name = "bag",
                              .says = "nav_msgs/Path and Odometry (CDR) and the power (JSON) over time, for "
                                      "Foxglove and PlotJuggler (MCAP)",
                              .write = export_bag,
                              .write_log = log_bag,
                              .example = "logs/run_01.csv --robot robot.yaml --to bag --out log.mcap"});
}

}  // namespace joulepath
