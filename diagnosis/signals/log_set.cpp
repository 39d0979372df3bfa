#include "diagnosis/signals/log_set.hpp"

#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/signals/sampled_supply.hpp"

namespace joulepath {
namespace {

/// The run smoothed as little as its log allows.
RunSignals finest_signals(const LogSet& logs, const RunSignals& signals) {
  const SignalOptions finest{.kernel_sigma_s = signals.log_period_s, .period_s = signals.log_period_s};
  return make_run_signals(logs.dataset->runs[signals.run_index], signals.run_index, logs.dataset->robot,
                          finest);
}

}  // namespace

std::vector<RunSignals> read_signals(const LogSet& logs, double delay_s) {
  std::vector<RunSignals> signals(logs.runs.size());
  SignalOptions options = logs.options;
  options.channel_delay_s = delay_s;
  parallel_for(logs.runs.size(), [&](std::size_t r) {
    signals[r] =
        make_run_signals(logs.dataset->runs[logs.runs[r]], logs.runs[r], logs.dataset->robot, options);
    const auto estimated = logs.estimated_payload_kg.find(logs.runs[r]);
    if (estimated != logs.estimated_payload_kg.end()) signals[r].payload_kg.setConstant(estimated->second);
    if (!measures_motors(signals[r]) && measures_energy(signals[r]))
      signals[r].expected_beyond_mean_W =
          supply_beyond_mean_W(signals[r], finest_signals(logs, signals[r]), logs.dataset->robot);
  });
  return signals;
}

}  // namespace joulepath
