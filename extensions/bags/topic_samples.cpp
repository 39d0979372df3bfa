#include "extensions/bags/topic_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <utility>

#include "model/median.hpp"

// Design: docs/decisions/0602-bags.md
namespace joulepath {
namespace {

constexpr double kOtherClock_s = 1.0;  ///< stamps that differ more from the log times belong to another clock
constexpr double kSteppedBack_s = 1.0;

bool strictly_ascending(const std::vector<double>& times) {
  return std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
}

/// Log time minus stamp, for each message.
template <class Take>
void each_lag(const TopicSamples& samples, Take&& take) {
  auto stamp_s = samples.stamp_s.begin();
  samples.log_times.each([&](double log_s) { take(log_s - *stamp_s++); });
}

/// Whether the median lag is greater than kOtherClock_s in size, by counts: without a copy of a long log.
bool other_clock(const TopicSamples& samples) {
  const std::size_t middle = samples.stamp_s.size() / 2;
  std::size_t late = 0, early = 0;
  each_lag(samples, [&](double lag_s) {
    late += lag_s > kOtherClock_s ? 1 : 0;
    early += lag_s < -kOtherClock_s ? 1 : 0;
  });
  return samples.stamp_s.size() - late <= middle || early > middle;
}

double median_lag_s(const TopicSamples& samples) {
  std::vector<double> lags;
  each_lag(samples, [&](double lag_s) { lags.push_back(lag_s); });
  return upper_median(std::move(lags));
}

class TableOfSamples {
 public:
  TableOfSamples(TopicSamples samples, std::string run, std::vector<LogArtifact>& artifacts)
      : samples_(std::move(samples)), run_(std::move(run)), artifacts_(artifacts) {}

  CsvTable table(const std::string& file) {
    CsvTable table{.file = file};
    table.header.push_back("time_s");
    table.columns.push_back(clock());
    samples_.log_times = {};
    const auto has_value = [](double value) { return !std::isnan(value); };
    for (std::size_t i = 0; i < samples_.columns.size(); ++i) {
      if (samples_.free_form && !std::ranges::any_of(samples_.values[i], has_value)) continue;
      table.header.push_back(samples_.columns[i]);
      table.columns.push_back(std::move(samples_.values[i]));
    }
    if (strictly_ascending(table.columns.front())) return table;
    const std::vector<std::size_t> order = order_of(table.columns.front());
    for (std::vector<double>& column : table.columns) {
      std::vector<double> ordered;
      ordered.reserve(order.size());
      for (const std::size_t i : order) ordered.push_back(column[i]);
      column = std::move(ordered);
    }
    return table;
  }

 private:
  void tell(const char* kind, const std::string& text, std::size_t count) {
    artifacts_.push_back({kind, run_, samples_.name, text, count, 0.0});
  }

  std::vector<double> clock() {
    std::vector<double>& stamp_s = samples_.stamp_s;
    if (!samples_.stamped) return std::move(stamp_s);
    if (other_clock(samples_)) {
      char text[112];
      std::snprintf(text, sizeof text, "stamps are %.3f s before the log times: log times are taken",
                    median_lag_s(samples_));
      tell("other_clock", text, stamp_s.size());
      return samples_.log_times.seconds();
    }
    const auto back = [](double before_s, double after_s) { return after_s < before_s - kSteppedBack_s; };
    if (std::ranges::adjacent_find(stamp_s, back) == stamp_s.end()) return std::move(stamp_s);
    tell("other_clock", "stamps step back: log times are taken", 1);
    return samples_.log_times.seconds();
  }

  /// The order of the messages: ascending times, each once.
  std::vector<std::size_t> order_of(const std::vector<double>& times) {
    std::vector<std::size_t> order(times.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto earlier = [&](std::size_t a, std::size_t b) { return times[a] < times[b]; };
    if (!std::is_sorted(order.begin(), order.end(), earlier)) {
      std::size_t late = 0;
      for (std::size_t i = 1; i < times.size(); ++i) late += times[i] < times[i - 1] ? 1 : 0;
      tell("out_of_order", "messages out of order were sorted by time", late);
      std::stable_sort(order.begin(), order.end(), earlier);
    }
    const auto same = [&](std::size_t a, std::size_t b) { return times[a] == times[b]; };
    const auto end = std::unique(order.begin(), order.end(), same);
    if (const auto repeated = order.end() - end; repeated > 0)
      tell("repeated", "messages with the time of the one before were left out",
           static_cast<std::size_t>(repeated));
    order.erase(end, order.end());
    return order;
  }

  TopicSamples samples_;
  std::string run_;
  std::vector<LogArtifact>& artifacts_;
};

}  // namespace

void LogTimes::add(std::uint64_t time_ns) {
  const auto step_ns = static_cast<std::int64_t>(time_ns - last_ns_);
  if (step_ns > kFar && step_ns <= INT32_MAX) {
    steps_ns_.push_back(static_cast<std::int32_t>(step_ns));
  } else {
    steps_ns_.push_back(kFar);
    far_ns_.push_back(time_ns);
  }
  last_ns_ = time_ns;
}

std::vector<double> LogTimes::seconds() const {
  std::vector<double> times;
  times.reserve(size());
  each([&](double time_s) { times.push_back(time_s); });
  return times;
}

CsvTable table_of_samples(TopicSamples samples, const std::string& file, const std::string& run,
                          std::vector<LogArtifact>& artifacts) {
  return TableOfSamples(std::move(samples), run, artifacts).table(file);
}

}  // namespace joulepath
