#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/checks/faults.hpp"
#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// What a channel of one run shows of the change that the other channels imply.
struct FollowedChannel {
  std::vector<std::string> columns{};
  double followed{};   ///< share of the expected change that the channel shows; 1 = all
  double expected{};   ///< rms of the expected change, unit of the channel
  bool is_dead{};      ///< the expected change is large enough to tell, and the channel does not show it
  bool is_alive{};     ///< the expected change is large enough to tell, and the channel shows it
  bool is_constant{};  ///< one value throughout
  bool needed{};       ///< the run cannot be used without this channel (a wheel's speed)
};

/// The channels that the run has and whose change its motion implies, always in the same order.
[[nodiscard]] std::vector<FollowedChannel> followed_channels(const RunSignals& run, const Robot& robot);

/// The runs in which a channel is dead: all that have it where each run that could show the contrary is one
/// of them.
[[nodiscard]] std::vector<std::size_t> dead_runs(const std::map<std::size_t, FollowedChannel>& runs);

}  // namespace joulepath
