#include "scenarios/bags/bag_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>

#include "scenarios/bags/bag_file.hpp"
#include "scenarios/bags/bag_survey.hpp"
#include "scenarios/bags/byte_reader.hpp"
#include "scenarios/bags/message_numbers.hpp"

// Design: docs/decisions/0261-bags-are-tables.md
namespace joulepath {
namespace {

constexpr double kOtherClock_s = 1.0;  ///< stamps that differ more from the log times belong to another clock
constexpr double kSteppedBack_s = 1.0;

/// One topic during reading.
struct Topic {
  std::string name{};
  std::unique_ptr<MessageNumbers> reader{};
  std::vector<std::string> columns{};
  std::vector<double> stamp_s{}, log_s{};
  std::vector<std::vector<double>> values{};
  bool stamped{};
  bool free_form{};  ///< no definition of its fields is known: a field that no message has is absent
  std::size_t broken{};
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool strictly_ascending(const std::vector<double>& times) {
  return std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
}

class BagLogReader {
 public:
  BagLogReader(const std::string& file, const NamedBy& named_by, const ColumnSources& sources,
               std::string run)
      : file_(file), run_(std::move(run)) {
    log_.sources = sources;
    for (const auto& [column, source] : sources)
      if (column != "time_s") any_given_ = any_given_ || (!source.from.empty() && !names_column(source));
    if (!any_given_) log_.sources = with_given(suggested_columns(survey_bag(file, named_by)), sources);
    damage_ = read_bag(
        file, named_by, [&](const BagChannel& channel) { open(channel); },
        [&](const BagMessage& message) { take(message); });
  }

  BagLog finish(const NamedBy& named_by) {
    tell_damage();
    std::vector<Topic*> order;
    for (Topic& topic : topics_)
      if (topic.reader && !topic.log_s.empty()) order.push_back(&topic);
    if (order.empty())
      throw named_by.error(file_, any_given_ ? "none of the mapped topics" : "no topic with a motion",
                           "a bag with Odometry or JointState, or columns: that name its topics",
                           "joulepath check lists the topics and proposes a dataset");
    std::stable_sort(order.begin(), order.end(),
                     [&](const Topic* a, const Topic* b) { return rank(*a) < rank(*b); });
    for (Topic* topic : order) log_.tables.push_back(table(*topic));
    return std::move(log_);
  }

 private:
  /// Whether a source is another of the format's columns (sides that are exchanged), not a topic.
  static bool names_column(const ColumnSource& source) {
    return source.from.size() == 1 && find_log_column(source.from.front()) != nullptr;
  }

  /// The suggested columns, overridden by columns that are given without a topic (a scale, a delay, an absent
  /// column).
  static ColumnSources with_given(const ColumnSources& suggested, const ColumnSources& given) {
    ColumnSources sources = suggested;
    for (const auto& [column, source] : given) {
      ColumnSource& changed = sources[column] = source;
      const auto known = suggested.find(names_column(source) ? source.from.front() : column);
      if (known == suggested.end() || (!source.from.empty() && !names_column(source))) continue;
      changed.from = known->second.from;
      changed.scale *= known->second.scale;
    }
    return sources;
  }

  void open(const BagChannel& channel) {
    topics_.push_back({.name = channel.topic});
    Topic& topic = topics_.back();
    std::vector<std::string> paths;
    for (const auto& [column, source] : log_.sources)
      for (const std::string& from : source.from) {
        std::string path;
        if (!split_source(from, channel.topic, path)) continue;
        if (std::ranges::count(topic.columns, from) > 0) continue;
        topic.columns.push_back(from);
        paths.push_back(path);
      }
    if (paths.empty()) return;
    topic.reader = message_numbers(channel);
    topic.free_form = channel.encoding == "json";
    if (!topic.reader) {
      tell("unreadable", channel.topic,
           "messages of type " + channel.type + " in encoding " + channel.encoding, 1);
      return;
    }
    for (const std::string& path : paths) topic.reader->want(path);
    topic.reader->want("header.stamp.sec");
    topic.reader->want("header.stamp.nanosec");
    topic.values.resize(paths.size());
  }

  void take(const BagMessage& message) {
    Topic& topic = topics_[message.channel];
    if (!topic.reader) return;
    try {
      topic.reader->read(message.data, numbers_);
    } catch (const BytesEnd&) {
      ++topic.broken;
      return;
    }
    const std::size_t n = topic.columns.size();
    for (std::size_t i = 0; i < n; ++i)
      topic.values[i].push_back(std::isfinite(numbers_[i]) ? numbers_[i] : std::nan(""));
    topic.log_s.push_back(1e-9 * static_cast<double>(message.log_time_ns));
    const double stamp_s = numbers_[n] + 1e-9 * numbers_[n + 1];
    const bool stamped = std::isfinite(stamp_s) && stamp_s != 0.0;
    topic.stamp_s.push_back(stamped ? stamp_s : topic.log_s.back());
    topic.stamped = topic.stamped || stamped;
  }

  void tell(const char* kind, const std::string& channel, const std::string& text, std::size_t count) {
    log_.artifacts.push_back({kind, run_, channel, text, count, 0.0});
  }

  void tell_damage() {
    if (damage_.truncated) tell("truncated", "", "the bag is truncated; its complete records were read", 1);
    if (damage_.broken_chunks > 0)
      tell("broken", "", "chunks that do not decompress or have a wrong check sum were left out",
           damage_.broken_chunks);
    if (damage_.broken_records > 0)
      tell("broken", "", "broken records were left out", damage_.broken_records);
    for (const Topic& topic : topics_)
      if (topic.broken > 0) tell("broken", topic.name, "messages that end early were left out", topic.broken);
  }

  /// Priority of a topic as the source of the run's times: wheels first, then body, then pose.
  [[nodiscard]] int rank(const Topic& topic) const {
    int rank = 0;
    for (const char* column : {"wheel_speed_left_rad_s", "linear_speed_m_s", "position_x_m"}) {
      const auto source = log_.sources.find(column);
      if (source != log_.sources.end())
        for (const std::string& from : source->second.from)
          if (std::ranges::count(topic.columns, from) > 0) return rank;
      ++rank;
    }
    return rank;
  }

  /// The stamps; the log times if the stamps belong to another clock or step back.
  std::vector<double> clock(const Topic& topic) {
    if (!topic.stamped) return topic.log_s;
    std::vector<double> lag_s(topic.log_s.size());
    std::transform(topic.log_s.begin(), topic.log_s.end(), topic.stamp_s.begin(), lag_s.begin(),
                   std::minus<>());
    const double lag = median(std::move(lag_s));
    if (std::abs(lag) > kOtherClock_s) {
      char text[112];
      std::snprintf(text, sizeof text, "stamps are %.3f s before the log times: log times are used", lag);
      tell("other_clock", topic.name, text, topic.log_s.size());
      return topic.log_s;
    }
    for (std::size_t i = 1; i < topic.stamp_s.size(); ++i)
      if (topic.stamp_s[i] < topic.stamp_s[i - 1] - kSteppedBack_s) {
        tell("other_clock", topic.name, "stamps step back: log times are used", 1);
        return topic.log_s;
      }
    return topic.stamp_s;
  }

  /// The order of the messages: ascending times, each once.
  std::vector<std::size_t> order_of(const std::vector<double>& times, const Topic& topic) {
    std::vector<std::size_t> order(times.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto earlier = [&](std::size_t a, std::size_t b) { return times[a] < times[b]; };
    if (!std::is_sorted(order.begin(), order.end(), earlier)) {
      std::size_t late = 0;
      for (std::size_t i = 1; i < times.size(); ++i) late += times[i] < times[i - 1] ? 1 : 0;
      tell("out_of_order", topic.name, "messages out of order were sorted by time", late);
      std::stable_sort(order.begin(), order.end(), earlier);
    }
    const auto same = [&](std::size_t a, std::size_t b) { return times[a] == times[b]; };
    const auto end = std::unique(order.begin(), order.end(), same);
    if (const auto repeated = order.end() - end; repeated > 0)
      tell("repeated", topic.name, "messages with the time of the previous message were left out",
           static_cast<std::size_t>(repeated));
    order.erase(end, order.end());
    return order;
  }

  CsvTable table(Topic& topic) {
    CsvTable table{.file = file_};
    table.header.push_back("time_s");
    table.columns.push_back(clock(topic));
    const auto has_value = [](double value) { return !std::isnan(value); };
    for (std::size_t i = 0; i < topic.columns.size(); ++i) {
      if (topic.free_form && !std::ranges::any_of(topic.values[i], has_value)) continue;
      table.header.push_back(topic.columns[i]);
      table.columns.push_back(std::move(topic.values[i]));
    }
    const std::vector<double>& times = table.columns.front();
    if (!strictly_ascending(times)) {
      const std::vector<std::size_t> order = order_of(times, topic);
      for (std::vector<double>& column : table.columns) {
        std::vector<double> ordered;
        for (const std::size_t i : order) ordered.push_back(column[i]);
        column = std::move(ordered);
      }
    }
    table.line_of_row.assign(table.columns.front().size(), 0);
    topic = {};
    return table;
  }

  std::string file_;
  std::string run_;
  BagLog log_{};
  bool any_given_{};
  BagDamage damage_{};
  std::vector<Topic> topics_{};
  std::vector<double> numbers_{};
};

}  // namespace

bool is_log_file(const std::string& file) {
  return std::filesystem::path(file).extension() == ".csv" || is_bag(file);
}

BagLog read_bag_log(const std::string& file, const NamedBy& named_by, const ColumnSources& sources,
                    const std::string& run) {
  return BagLogReader(file, named_by, sources, run).finish(named_by);
}

}  // namespace joulepath
