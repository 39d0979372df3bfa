#include "diagnosis/evidence/another_robot.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "diagnosis/checks/foreign_robot.hpp"
#include "diagnosis/evidence/delay_search.hpp"

namespace joulepath {
namespace {

/// Whether the checks found a fault of the drive's channels that is an excuse for other constants. A dead
/// channel is none: its readings determined the constants.
bool has_excuse(const std::vector<DataCheck>& checks) {
  return std::ranges::any_of(checks, [](const DataCheck& check) {
    return check.kind != "dead" && !check.channel.starts_with("battery_");
  });
}

}  // namespace

std::vector<ForeignConstant> constants_of_another_robot(const Dataset& dataset, const RunsByUse& runs,
                                                        const std::vector<DataCheck>& checks) {
  std::set<std::size_t> faulty;
  for (const DataCheck& check : checks)
    if (!check.run.empty()) faulty.insert(check.runs.begin(), check.runs.end());
  std::vector<RunSignals> sound;
  std::ranges::copy_if(runs.signals, std::back_inserter(sound),
                       [&](const RunSignals& run) { return !faulty.contains(run.run_index); });
  const bool excused = has_excuse(checks);
  if (!faulty.empty() && !sound.empty() && foreign_constants(dataset.robot, sound, excused).empty())
    return {};
  const std::vector<ForeignConstant> constants = foreign_constants(dataset.robot, runs.signals, excused);
  const double delay_s = constants.empty() ? 0.0 : rough_channel_delay_s(runs.diagnosis);
  return delay_s == 0 ? constants
                      : foreign_constants(dataset.robot, read_signals(runs.diagnosis, delay_s), excused);
}

}  // namespace joulepath
