#pragma once

#include <vector>

#include "model/limit_table.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// A request's limits for another load than planned, read from a table: limits_for_payload() allocates.
class LoadedLimits {
 public:
  /// `planned`: the limits that a request has for its payload.
  LoadedLimits(const Robot& robot, const Limits& planned, const PayloadAlongPath& payload);

  const Limits& planned() const { return planned_; }
  /// Limits that hold for all payloads between two. A limit that the request lowered stays lowered in the
  /// same proportion.
  [[nodiscard]] Limits between(double least_kg, double most_kg) const;

 private:
  struct Row {
    double payload_kg{};
    Limits limits{};
  };
  [[nodiscard]] Limits at(double payload_kg) const;

  std::vector<Row> rows_{};  ///< ascending; between them each finite limit is linear
  Limits planned_{};
  Limits table_at_planned_{};
};

}  // namespace joulepath
