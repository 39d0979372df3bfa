#include "extensions/bags/bag_log.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "extensions/bags/bag_file.hpp"
#include "extensions/bags/bag_survey.hpp"
#include "extensions/bags/byte_cursor.hpp"
#include "extensions/bags/field_path.hpp"
#include "extensions/bags/message_numbers.hpp"
#include "extensions/bags/topic_samples.hpp"
#include "model/text_of_list.hpp"

// Design: docs/decisions/0602-bags.md
namespace joulepath {
namespace {

/// One topic during reading.
struct Topic {
  TopicSamples samples{};
  std::vector<std::string> paths{};  ///< of the columns
  std::unique_ptr<MessageNumbers> reader{};
  std::size_t broken{};
};

/// Takes out the sources that name a field which the messages do not have, or an element that none of them
/// names: a mistyped name is not a channel without values.
void drop_unknown_sources(Topic& topic) {
  const auto is_named = [](const FieldStep& step) { return step.element && !element_index(*step.element); };
  const auto is_number = [](double value) { return std::isfinite(value); };
  for (std::size_t i = topic.paths.size(); i-- > 0;) {
    const bool known = !std::ranges::any_of(field_path(topic.paths[i]), is_named) ||
                       std::ranges::any_of(topic.samples.values[i], is_number);
    if (known && topic.reader->has(topic.paths[i])) continue;
    topic.samples.columns.erase(topic.samples.columns.begin() + static_cast<std::ptrdiff_t>(i));
    topic.samples.values.erase(topic.samples.values.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

class BagLogReader {
 public:
  BagLogReader(const std::string& file, const NamedBy& named_by, const ColumnSources& sources,
               std::string run)
      : file_(file), run_(std::move(run)) {
    log_.sources = sources;
    for (auto& [column, source] : log_.sources)
      if (source.is_absent) source.from.clear();
    for (const auto& [column, source] : sources)
      if (column != "time_s") any_given_ = any_given_ || (!source.from.empty() && !names_column(source));
    use(suggested_columns(survey_bag(file, named_by)));
    damage_ = read_bag(
        file, named_by, [&](const MessageChannel& channel) { open(channel); },
        [&](const TimedMessage& message) { take(message); });
  }

  LogTables finish(const NamedBy& named_by) {
    tell_damage();
    std::vector<Topic*> order;
    for (Topic& topic : topics_)
      if (topic.reader && !topic.samples.stamp_s.empty()) {
        drop_unknown_sources(topic);
        order.push_back(&topic);
      }
    if (order.empty()) refuse(named_by);
    std::stable_sort(order.begin(), order.end(),
                     [&](const Topic* a, const Topic* b) { return rank(*a) < rank(*b); });
    for (Topic* topic : order)
      log_.tables.push_back(table_of_samples(std::move(topic->samples), file_, run_, log_.artifacts));
    return std::move(log_);
  }

 private:
  /// Whether a source is another of the format's columns (sides that are exchanged), not a topic.
  static bool names_column(const ColumnSource& source) {
    return source.from.size() == 1 && find_log_column(source.from.front()) != nullptr;
  }

  /// A heading or a quaternion: one quantity, which is given or suggested as a whole.
  static bool is_heading(const std::string& column) {
    return column == "heading_rad" || std::ranges::count(kOrientationColumns, column) > 0;
  }

  /// Adds the suggested columns. A given column without a topic (a scale, a delay, an exchanged side) changes
  /// the suggested one; any other given column takes its place.
  void use(ColumnSources suggested) {
    ColumnSources& sources = log_.sources;
    for (auto& [column, source] : sources) {
      const auto known = suggested.find(names_column(source) ? source.from.front() : column);
      if (known == suggested.end() || source.is_absent || (!source.from.empty() && !names_column(source)))
        continue;
      source.from = known->second.from;
      source.scale *= known->second.scale;
    }
    const bool has_heading = std::ranges::any_of(sources, [](const auto& entry) {
      return is_heading(entry.first) && (entry.second.is_absent || !entry.second.from.empty());
    });
    std::string added;
    for (auto& [column, source] : suggested) {
      if (has_heading && is_heading(column)) continue;
      if (sources.try_emplace(column, std::move(source)).second) append_item(added, column);
    }
    if (any_given_ && !added.empty())
      tell("proposed", "", added + ": read as the types of the topics propose, beside the mapped columns", 1);
  }

  [[noreturn]] void refuse(const NamedBy& named_by) const {
    if (messages_ == 0) throw named_by.error(file_, no_message_text(damage_), "a bag with messages");
    throw named_by.error(file_, any_given_ ? "none of the mapped topics" : "no topic with a motion",
                         "a bag with Odometry or JointState, or columns: that name its topics",
                         "joulepath check lists the topics and proposes a dataset");
  }

  void open(const MessageChannel& channel) {
    topics_.push_back({.samples = {.name = channel.topic}});
    Topic& topic = topics_.back();
    TopicSamples& samples = topic.samples;
    std::vector<std::string>& paths = topic.paths;
    for (const auto& [column, source] : log_.sources)
      for (const std::string& from : source.from) {
        std::string path;
        if (!split_source(from, channel.topic, path)) continue;
        if (std::ranges::count(samples.columns, from) > 0) continue;
        samples.columns.push_back(from);
        paths.push_back(path);
      }
    if (paths.empty()) return;
    topic.reader = message_numbers(channel);
    samples.free_form = channel.encoding == "json";
    if (!topic.reader) {
      tell("unreadable", channel.topic,
           "messages of type " + channel.type + " in encoding " + channel.encoding, 1);
      return;
    }
    for (const std::string& path : paths) topic.reader->want(path);
    topic.reader->want("header.stamp.sec");
    topic.reader->want("header.stamp.nanosec");
    samples.values.resize(paths.size());
  }

  void take(const TimedMessage& message) {
    ++messages_;
    Topic& topic = topics_[message.channel];
    if (!topic.reader) return;
    try {
      topic.reader->read(message.data, numbers_);
    } catch (const BytesEnd&) {
      ++topic.broken;
      return;
    }
    TopicSamples& samples = topic.samples;
    const std::size_t n = samples.columns.size();
    for (std::size_t i = 0; i < n; ++i)
      samples.values[i].push_back(std::isfinite(numbers_[i]) ? numbers_[i] : std::nan(""));
    samples.log_times.add(message.log_time_ns);
    const double stamp_s = numbers_[n] + 1e-9 * numbers_[n + 1];
    const bool stamped = std::isfinite(stamp_s) && stamp_s != 0.0;
    samples.stamp_s.push_back(stamped ? stamp_s : 1e-9 * static_cast<double>(message.log_time_ns));
    samples.stamped = samples.stamped || stamped;
  }

  void tell(const char* kind, const std::string& channel, const std::string& text, std::size_t count) {
    log_.artifacts.push_back({kind, run_, channel, text, count, 0.0});
  }

  void tell_damage() {
    if (damage_.truncated)
      tell("truncated", "", truncation_text(damage_) + "; the records before were read", 1);
    if (damage_.broken_chunks > 0)
      tell("broken", "", "chunks that do not decompress or have a wrong check sum were left out",
           damage_.broken_chunks);
    if (damage_.broken_records > 0)
      tell("broken", "", "broken records were left out", damage_.broken_records);
    for (const Topic& topic : topics_)
      if (topic.broken > 0)
        tell("broken", topic.samples.name, "messages that end early were left out", topic.broken);
  }

  /// Priority of a topic as the source of the run's times: wheels first, then body, then pose.
  [[nodiscard]] int rank(const Topic& topic) const {
    int rank = 0;
    for (const char* column : {"wheel_speed_left_rad_s", "linear_speed_m_s", "position_x_m"}) {
      const auto source = log_.sources.find(column);
      if (source != log_.sources.end())
        for (const std::string& from : source->second.from)
          if (std::ranges::count(topic.samples.columns, from) > 0) return rank;
      ++rank;
    }
    return rank;
  }

  std::string file_;
  std::string run_;
  LogTables log_{};
  bool any_given_{};
  MessageDamage damage_{};
  std::size_t messages_{};
  std::vector<Topic> topics_{};
  std::vector<double> numbers_{};
};

}  // namespace

LogTables read_bag_log(const std::string& file, const NamedBy& named_by, const ColumnSources& sources,
                       const std::string& run) {
  return BagLogReader(file, named_by, sources, run).finish(named_by);
}

}  // namespace joulepath
