#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "diagnosis/checks/column_bounds.hpp"
#include "extensions/onboard/monitor/cause_watch.hpp"
#include "extensions/onboard/monitor/energy_meter.hpp"
#include "extensions/onboard/monitor/log_excerpt.hpp"
#include "extensions/onboard/monitor/planned_course.hpp"

namespace joulepath {

struct MonitorOptions {
  double hours_per_false_alarm{100.0};
  double status_every_s{10.0};
};

/// Rows of a log that a monitor could not use as they are.
struct RowCounts {
  std::uint64_t used{};
  std::uint64_t late{};     ///< not later than one before (doubled, out of order), or alone on another clock
  std::uint64_t broken{};   ///< without a time or a wheel speed, or with a number that no robot has
  std::uint64_t missing{};  ///< that a gap of the clock left out
};

/// Where a drive stands.
struct MonitorStatus {
  double time_s{};
  std::size_t leg{};
  double executed_J{};
  double planned_J{};  ///< to the same place of the plan
  bool measured{};     ///< false: no channel of power yet
  std::optional<double> payload_kg{};
  std::optional<std::array<double, 2>> payload_interval_95{};
  double rest_J{};  ///< of the plan
  /// 95 %: with the drive's excess so far and the plan's own uncertainty; absent where the plan states none.
  std::optional<double> rest_upper_J{};
  std::optional<double> battery_fraction{};
  std::optional<bool> battery_suffices{};  ///< for the rest's upper bound, above the reserve
  double bridged_s{};
  RowCounts rows{};
};

struct PayloadChanged {
  double time_s{};
  double since_s{};
  double stated_kg{};
  double payload_kg{};
  std::array<double, 2> interval_95{};
};

/// Something other than the payload resists: the day's log goes to `diagnose`.
struct NotPayload {
  double time_s{};
  double since_s{};
  double resistance_percent{};  ///< of the nominal dry friction
  std::array<double, 2> interval_95{};
  std::string looks_like{};
  std::string reason{};
};

/// A leg, at its end or where the log ends.
struct LegExecuted {
  double time_s{};
  std::size_t leg{};
  double executed_J{};
  double planned_J{};
  bool deviates{};  ///< by more than the plan's uncertainty explains
  bool finished{};
};

using MonitorEvent = std::variant<MonitorStatus, PayloadChanged, NotPayload, LegExecuted>;

/// Compares a log with its plan while it grows. Constant memory; no row stops it. One row on another clock is
/// left out. Where the next rows follow it, the clock was set anew: times go on on the first clock.
class Monitor {
 public:
  Monitor(const Robot& robot, PlannedCourse course, const MonitorOptions& options);
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  /// What the row of the log completes; valid until the next call.
  [[nodiscard]] const std::vector<MonitorEvent>& add(const MonitorRow& logged);
  [[nodiscard]] MonitorStatus status() const;
  /// The present leg so far.
  [[nodiscard]] LegExecuted leg_executed() const;
  /// A channel in another unit, dead, swapped or inverted, by the checks of logs in files: what was told so
  /// far is wrong.
  [[nodiscard]] const std::optional<Implausible>& implausible() const { return implausible_; }
  /// The same once more, of a log that has ended.
  [[nodiscard]] const std::optional<Implausible>& judge_end();

 private:
  [[nodiscard]] bool is_possible(const MonitorRow& row);
  [[nodiscard]] bool is_usable(const MonitorRow& row);
  [[nodiscard]] bool is_on_the_clock(double time_s);
  [[nodiscard]] MonitorEvent told(const CauseChange& change, double stated_kg) const;
  [[nodiscard]] double executed_at_J(double planned_J) const;
  void finish_legs();

  Robot robot_;
  PlannedCourse course_;
  MonitorOptions options_;
  std::array<ColumnBound, 12> bounds_;
  LogExcerpt excerpt_;
  CourseProgress progress_;
  EnergyMeter meter_;
  CauseWatch watch_;
  std::vector<MonitorEvent> events_{};
  RowCounts rows_{};
  std::uint64_t odd_rows_{};  ///< with a number that no robot has
  std::optional<Implausible> implausible_{};
  double clock_shift_s_{};      ///< of the log's clock against the first one
  double doubtful_s_{kAbsent};  ///< log time of the last row that was on another clock
  double last_s_{kAbsent}, last_rim_m_s_{}, next_status_s_{kAbsent}, period_s_{kAbsent}, stated_kg_{};
  std::size_t leg_{};
  double leg_begin_J_{};
};

}  // namespace joulepath
