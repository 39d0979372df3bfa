#pragma once

#include <optional>
#include <string>

#include "extensions/onboard/monitor/block_fit.hpp"
#include "extensions/onboard/monitor/e_detector.hpp"

namespace joulepath {

/// A change that the watch is sure of.
struct CauseChange {
  bool payload{};            ///< false: something else that resists the motion
  double time_s{};           ///< of the alarm
  double since_s{};          ///< when it began, at the earliest window that shows it
  Estimate extra_kg{};       ///< beyond the stated payload, since then
  Estimate resistance{};     ///< beyond the nominal dry friction, as a share of it
  std::string looks_like{};  ///< the effect of the catalog that alone explains most
  std::string reason{};      ///< why it is not payload
};

/// Tells a change of the payload from a change of anything else, over blocks of windows from stop to stop.
class CauseWatch {
 public:
  CauseWatch(const Robot& robot, double hours_per_false_alarm);

  /// A row, later than the one before, with the payload that is stated for it.
  [[nodiscard]] std::optional<CauseChange> add(const MonitorRow& row, double payload_kg);

  /// What is known of the payload beyond the stated one since the last change; none before the first block.
  [[nodiscard]] std::optional<Estimate> extra_kg() const;
  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  double tolerance_kg() const { return tolerance_kg_; }

 private:
  /// Mean of estimates, weighted by their information.
  struct Pool {
    double information{}, sum{};
    std::size_t count{};
    void add(const Estimate& x);
    [[nodiscard]] Estimate mean() const;
  };

  [[nodiscard]] bool is_weighed() const;
  void pool(const BlockEstimate& block, bool weighs);
  void pool_payload(const BlockEstimate& block);
  [[nodiscard]] bool block_is_over(const MonitorRow& row) const;
  [[nodiscard]] std::optional<CauseChange> close_block();
  [[nodiscard]] double noise(const BlockFit::Leftover& leftover);
  [[nodiscard]] double scatter(const Estimate& extra_kg);
  [[nodiscard]] CauseChange payload_or_not(const BlockEstimate& block);
  [[nodiscard]] CauseChange other_cause(const BlockEstimate& block, const EDetector& alarmed,
                                        std::string reason);
  void restart();

  Signatures signatures_;
  MotionWindows windows_;
  double tolerance_kg_{};
  EDetector payload_, resistance_;
  BlockFit block_;
  BlockFit suspected_;  ///< since the first sign of a change
  Pool extra_kg_{};     ///< since the last change
  Pool suspected_kg_{}, suspected_disagreement_{}, suspected_resistance_{};  ///< since the suspected one
  std::size_t payload_blocks_{}, resistance_blocks_{};
  double known_kg_{};        ///< beyond the stated payload, at the last change of it
  double unexplained_kg_{};  ///< that another cause seemed to weigh: smaller changes are not payload
  double last_turning_s_{kAbsent}, last_block_end_s_{kAbsent};
  double squares_{}, freedom_{};   ///< of all rows, with forgetting
  double jumps_{}, jump_count_{};  ///< of estimates from block to block, with forgetting
  std::optional<Estimate> before_{};
  std::size_t blocks_{};
};

}  // namespace joulepath
