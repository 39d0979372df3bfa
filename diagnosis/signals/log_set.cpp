#include "diagnosis/signals/log_set.hpp"

#include "diagnosis/numerics/parallel.hpp"

namespace joulepath {

std::vector<RunSignals> read_signals(const LogSet& logs, double delay_s) {
  std::vector<RunSignals> signals(logs.runs.size());
  SignalOptions options = logs.options;
  options.channel_delay_s = delay_s;
  parallel_for(logs.runs.size(), [&](std::size_t r) {
    signals[r] =
        make_run_signals(logs.dataset->runs[logs.runs[r]], logs.runs[r], logs.dataset->robot, options);
    const auto estimated = logs.estimated_payload_kg.find(logs.runs[r]);
    if (estimated != logs.estimated_payload_kg.end()) signals[r].payload_kg.setConstant(estimated->second);
  });
  return signals;
}

}  // namespace joulepath
