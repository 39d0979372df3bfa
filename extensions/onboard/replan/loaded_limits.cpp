#include "extensions/onboard/replan/loaded_limits.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

double interpolated(double x0, double y0, double x1, double y1, double x) {
  if (std::isinf(y0) || std::isinf(y1)) return std::min(y0, y1);
  return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

/// Applies change(limit of `limits`, the same limit of `other`) to every limit of the table.
template <class Change>
void for_each_field(Limits& limits, const Limits& other, Change&& change) {
  for (const Limit& row : kLimits)
    if (row.field != nullptr) change(limits.*row.field, other.*row.field);
}

}  // namespace

LoadedLimits::LoadedLimits(const Robot& robot, const Limits& planned, const PayloadAlongPath& payload)
    : planned_(planned), table_at_planned_(limits_between_payloads(robot, payload.from_kg, payload.to_kg)) {
  for (const PayloadLimits& row : robot.limits_by_payload)
    rows_.push_back({row.payload_kg, limits_for_payload(robot, row.payload_kg)});
  std::sort(rows_.begin(), rows_.end(),
            [](const Row& a, const Row& b) { return a.payload_kg < b.payload_kg; });
}

Limits LoadedLimits::at(double payload_kg) const {
  if (payload_kg <= rows_.front().payload_kg) return rows_.front().limits;
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    const Row &before = rows_[i - 1], &behind = rows_[i];
    if (payload_kg >= behind.payload_kg) continue;
    Limits limits = before.limits;
    for_each_field(limits, behind.limits, [&](double& limit, double other) {
      limit = interpolated(before.payload_kg, limit, behind.payload_kg, other, payload_kg);
    });
    return limits;
  }
  return rows_.back().limits;
}

Limits LoadedLimits::between(double least_kg, double most_kg) const {
  if (rows_.empty()) return planned_;
  Limits loaded = at(least_kg);
  const auto take_smaller = [&](const Limits& other) {
    for_each_field(loaded, other, [](double& limit, double value) { limit = std::min(limit, value); });
  };
  take_smaller(at(most_kg));
  for (const Row& row : rows_)
    if (row.payload_kg > least_kg && row.payload_kg < most_kg) take_smaller(row.limits);
  Limits limits = planned_;
  for (const Limit& row : kLimits) {
    if (row.field == nullptr) continue;
    const double now = loaded.*row.field, then = table_at_planned_.*row.field;
    double& limit = limits.*row.field;
    limit = std::isfinite(then) && then > 0 ? limit * (now / then) : std::min(limit, now);
  }
  return limits;
}

}  // namespace joulepath
