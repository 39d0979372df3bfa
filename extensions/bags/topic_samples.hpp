#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/text/csv_table.hpp"

namespace joulepath {

/// When a recorder saw the messages of one topic. A message mostly comes within seconds of the one before, so
/// that a time takes 4 bytes.
class LogTimes {
 public:
  void add(std::uint64_t time_ns);
  [[nodiscard]] std::size_t size() const { return steps_ns_.size(); }
  [[nodiscard]] std::vector<double> seconds() const;

  /// Calls `take(time_s)` for each message.
  template <class Take>
  void each(Take&& take) const {
    std::uint64_t time_ns = 0;
    auto far = far_ns_.begin();
    for (const std::int32_t step_ns : steps_ns_) {
      time_ns = step_ns == kFar ? *far++ : time_ns + static_cast<std::uint64_t>(std::int64_t{step_ns});
      take(1e-9 * static_cast<double>(time_ns));
    }
  }

 private:
  static constexpr std::int32_t kFar = INT32_MIN;  ///< the time is the next of `far_ns_`

  std::vector<std::int32_t> steps_ns_{};
  std::vector<std::uint64_t> far_ns_{};
  std::uint64_t last_ns_{};
};

/// The wanted numbers of a topic's messages.
struct TopicSamples {
  std::string name{};
  std::vector<std::string> columns{};  ///< names of their sources
  std::vector<std::vector<double>> values{};
  std::vector<double> stamp_s{};  ///< the log time where a message has no stamp
  LogTimes log_times{};
  bool stamped{};    ///< some message has a stamp
  bool free_form{};  ///< no definition of its fields is known: a field that no message has is absent
};

/// The samples as the CSV file of them would be: ascending times, each once. The times are the stamps, or the
/// log times if the stamps belong to another clock or step back. What was changed is added to `artifacts`.
[[nodiscard]] CsvTable table_of_samples(TopicSamples samples, const std::string& file, const std::string& run,
                                        std::vector<LogArtifact>& artifacts);

}  // namespace joulepath
