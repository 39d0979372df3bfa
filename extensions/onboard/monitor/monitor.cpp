#include "extensions/onboard/monitor/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "model/normal_quantiles.hpp"
#include "model/printable.hpp"
#include "model/watt_hours.hpp"

namespace joulepath {
namespace {

constexpr double kShrink = 0.05;        ///< share of the plan that the first joules count for
constexpr double kLegTolerance = 0.03;  ///< of a leg's energy
constexpr double kSmoothing = 0.02;
constexpr double kMostAngle_rad = 1e6;
constexpr std::uint64_t kFewOdd = 20;    ///< rows with a number that no robot has; more are no glitches
constexpr std::uint64_t kOddShare = 10;  ///< where they are one in so many
constexpr double kClockJump_s = 60;      ///< a longer step has to be confirmed by the next row
constexpr double kLongestGap_s = 3600;   ///< a longer step is another clock, not time that passed

struct RowColumn {
  std::string_view name;
  double (*of)(const MonitorRow&);
};
constexpr RowColumn kRowColumns[] = {
    {"wheel_speed_left_rad_s", [](const MonitorRow& row) { return row.wheel_speed_rad_s.left; }},
    {"wheel_speed_right_rad_s", [](const MonitorRow& row) { return row.wheel_speed_rad_s.right; }},
    {"motor_voltage_left_V", [](const MonitorRow& row) { return row.motor_voltage_V.left; }},
    {"motor_voltage_right_V", [](const MonitorRow& row) { return row.motor_voltage_V.right; }},
    {"motor_current_left_A", [](const MonitorRow& row) { return row.motor_current_A.left; }},
    {"motor_current_right_A", [](const MonitorRow& row) { return row.motor_current_A.right; }},
    {"motor_power_left_W", [](const MonitorRow& row) { return row.motor_power_W.left; }},
    {"motor_power_right_W", [](const MonitorRow& row) { return row.motor_power_W.right; }},
    {"battery_voltage_V", [](const MonitorRow& row) { return row.battery_voltage_V; }},
    {"battery_current_A", [](const MonitorRow& row) { return row.battery_current_A; }},
    {"payload_kg", [](const MonitorRow& row) { return row.payload_kg; }},
};

std::array<double, 2> interval_95(double value, double sigma) {
  return {value - kNormal95 * sigma, value + kNormal95 * sigma};
}

}  // namespace

Monitor::Monitor(const Robot& robot, PlannedCourse course, const MonitorOptions& options)
    : robot_(robot),
      course_(std::move(course)),
      options_(options),
      bounds_(column_bounds(robot)),
      excerpt_(robot),
      progress_(course_),
      meter_(robot.power),
      watch_(robot, options.hours_per_false_alarm) {}

/// Whether the log's clock goes on from the last row. A step that is too long counts when a second row
/// follows.
bool Monitor::is_on_the_clock(double time_s) {
  const double step_s = time_s - clock_shift_s_ - last_s_;
  if (!(std::abs(step_s) > kClockJump_s)) return true;
  const double confirmed_s = time_s - doubtful_s_;
  doubtful_s_ = time_s;
  if (!(confirmed_s > 0 && confirmed_s <= kClockJump_s)) return false;
  if (step_s < 0 || step_s > kLongestGap_s) clock_shift_s_ = time_s - last_s_ - confirmed_s;
  return true;
}

/// A number that no robot has: one such row would decide all sums. Rows that keep coming with it have another
/// unit.
bool Monitor::is_possible(const MonitorRow& row) {
  const auto refuse = [&](std::string channel, double value, double most, const char* hint) {
    if (++odd_rows_ > kFewOdd && kOddShare * odd_rows_ > rows_.used + odd_rows_ && !implausible_)
      implausible_ = {channel,
                      channel + " of " + four_digits(value) + " in " + std::to_string(odd_rows_) + " rows",
                      "at most " + four_digits(most), hint};
    return false;
  };
  if (std::abs(row.time_s) > kLatestClock_s) return refuse("time_s", row.time_s, kLatestClock_s, kClockHint);
  for (const RowColumn& column : kRowColumns) {
    const auto bound = std::ranges::find(bounds_, column.name, &ColumnBound::column);
    if (std::abs(column.of(row)) > bound->most)
      return refuse(std::string(column.name), column.of(row), bound->most, bound->hint);
  }
  return !(std::abs(row.heading_rad) > kMostAngle_rad);
}

bool Monitor::is_usable(const MonitorRow& row) {
  if (!std::isfinite(row.time_s) || !std::isfinite(row.wheel_speed_rad_s.left) ||
      !std::isfinite(row.wheel_speed_rad_s.right) || !is_possible(row)) {
    ++rows_.broken;
    return false;
  }
  const double step_s = row.time_s - last_s_;
  if (step_s <= 0) {
    ++rows_.late;
    return false;
  }
  if (std::isnan(period_s_)) period_s_ = step_s;
  if (step_s > 1.5 * period_s_)
    rows_.missing += static_cast<std::uint64_t>(std::min(step_s / period_s_ - 0.5, 1e9));
  if (!std::isnan(step_s)) period_s_ *= 1 + (step_s > period_s_ ? kSmoothing : -kSmoothing);
  ++rows_.used;
  return true;
}

const std::vector<MonitorEvent>& Monitor::add(const MonitorRow& logged) {
  events_.clear();
  const double before_s = last_s_;
  if (std::isfinite(logged.time_s) && !is_on_the_clock(logged.time_s)) {
    ++rows_.late;
    return events_;
  }
  MonitorRow row = logged;
  row.time_s -= clock_shift_s_;
  if (!is_usable(row)) return events_;
  last_s_ = row.time_s;
  if (std::isnan(next_status_s_)) next_status_s_ = row.time_s + options_.status_every_s;
  const double rim_m_s = rim_speed_m_s(robot_.geometry, row.wheel_speed_rad_s);
  if (row.time_s > before_s) progress_.advance(row.time_s - before_s, 0.5 * (rim_m_s + last_rim_m_s_));
  last_rim_m_s_ = rim_m_s;
  stated_kg_ = std::isnan(row.payload_kg) ? progress_.payload_kg() : row.payload_kg;
  if (const auto suspect = excerpt_.add(row, stated_kg_); suspect && !implausible_) implausible_ = suspect;
  meter_.add(row);
  if (const auto change = watch_.add(row, stated_kg_)) events_.push_back(told(*change, stated_kg_));
  finish_legs();
  if (row.time_s >= next_status_s_) {
    events_.emplace_back(status());
    next_status_s_ = row.time_s + options_.status_every_s;
  }
  return events_;
}

const std::optional<Implausible>& Monitor::judge_end() {
  if (!implausible_) implausible_ = excerpt_.judged();
  return implausible_;
}

MonitorEvent Monitor::told(const CauseChange& change, double stated_kg) const {
  if (!change.payload)
    return NotPayload{
        .time_s = change.time_s,
        .since_s = change.since_s,
        .resistance_percent = 100 * change.resistance.value,
        .interval_95 = interval_95(100 * change.resistance.value, 100 * change.resistance.sigma),
        .looks_like = change.looks_like,
        .reason = change.reason};
  const double sigma = std::hypot(change.extra_kg.sigma, watch_.tolerance_kg() / kNormal95OneSided);
  const double payload_kg = stated_kg + change.extra_kg.value;
  return PayloadChanged{.time_s = change.time_s,
                        .since_s = change.since_s,
                        .stated_kg = stated_kg,
                        .payload_kg = payload_kg,
                        .interval_95 = interval_95(payload_kg, sigma)};
}

/// The energy at a near place of the plan: what lies between there and here is as planned.
double Monitor::executed_at_J(double planned_J) const {
  return meter_.energy_J() + planned_J - progress_.energy_J();
}

LegExecuted Monitor::leg_executed() const {
  const bool next = progress_.leg() != leg_;
  const double planned_end_J = next ? progress_.leg_begin_J(progress_.leg()) : progress_.energy_J();
  LegExecuted leg{.time_s = last_s_,
                  .leg = leg_,
                  .executed_J = executed_at_J(planned_end_J) - leg_begin_J_,
                  .planned_J = planned_end_J - progress_.leg_begin_J(leg_),
                  .finished = next || progress_.has_arrived()};
  const double sigma_J = leg_ < course_.legs.size() ? course_.legs[leg_].sigma_J : 0.0;
  const double allowed_J = std::hypot(kNormal95 * sigma_J, kLegTolerance * leg.planned_J);
  leg.deviates = meter_.measures() && std::abs(leg.executed_J - leg.planned_J) > allowed_J;
  return leg;
}

void Monitor::finish_legs() {
  if (progress_.leg() == leg_) return;
  events_.emplace_back(leg_executed());
  leg_ = progress_.leg();
  leg_begin_J_ = executed_at_J(progress_.leg_begin_J(leg_));
}

MonitorStatus Monitor::status() const {
  const double whole_J = course_.energy_J.back(), planned_J = progress_.energy_J();
  MonitorStatus status{.time_s = last_s_,
                       .leg = progress_.leg(),
                       .executed_J = meter_.energy_J(),
                       .planned_J = planned_J,
                       .measured = meter_.measures(),
                       .rest_J = whole_J - planned_J,
                       .bridged_s = meter_.bridged_s(),
                       .rows = rows_};
  if (const std::optional<Estimate> extra = watch_.extra_kg()) {
    status.payload_kg = stated_kg_ + extra->value;
    status.payload_interval_95 = interval_95(*status.payload_kg, extra->sigma);
  }
  const double first_J = kShrink * whole_J;
  const double excess = std::max(1.0, (status.executed_J + first_J) / (planned_J + first_J));
  const double likely_J = status.rest_J * (status.measured ? excess : 1.0);
  if (course_.sigma_J && whole_J > 0)
    status.rest_upper_J = likely_J * (1 + kNormal95OneSided * *course_.sigma_J / whole_J);
  const double capacity_J = kJoulesPerWh * robot_.battery.capacity_Wh;
  if (course_.battery_fraction && std::isfinite(capacity_J) && status.measured) {
    status.battery_fraction = *course_.battery_fraction - status.executed_J / capacity_J;
    status.battery_suffices = (*status.battery_fraction - robot_.battery.reserve_fraction) * capacity_J >=
                              status.rest_upper_J.value_or(likely_J);
  }
  return status;
}

}  // namespace joulepath
