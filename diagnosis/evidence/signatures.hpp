#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "diagnosis/evidence/equations.hpp"

namespace joulepath {

/// Where a candidate's amplitudes stand in a state, and the changes of one of them that difference it: from
/// `low` (0 where physics allows no less) to `high`.
struct AmplitudeStep {
  std::vector<double> value{};
  double low{};
  double high{};
};
[[nodiscard]] AmplitudeStep amplitude_step(const ModelState& state, const Candidate& candidate,
                                           std::size_t part);

/// The state with that amplitude changed; the candidate is added where the state does not have it.
[[nodiscard]] ModelState with_change(const ModelState& state, const Candidate& candidate,
                                     const AmplitudeStep& step, std::size_t part, double change);

/// What the strength of a law may depend on beyond the textbook: one form column each.
inline constexpr std::array<std::string_view, 5> kFormVariables{"speed", "yaw rate", "payload",
                                                                "acceleration", "time of day"};

/// Columns of the linear problem about a state, without rows: nuisances, candidates, shapes of the
/// state's own effects, dictionary.
[[nodiscard]] std::vector<Column> list_columns(const Robot& robot, const std::vector<Nuisance>& nuisances,
                                               const ModelState& state,
                                               const std::vector<Candidate>& candidates,
                                               std::size_t dictionary_entries, bool forms);

/// d(structured rows)/d(parameter) of nuisances, amplitudes and shapes, each samples x kChannelCount:
/// central differences of predictions, which are free of noise.
[[nodiscard]] std::vector<Eigen::MatrixXd> signatures(const RunSignals& signals, const Robot& robot,
                                                      const std::vector<Nuisance>& nuisances,
                                                      const ModelState& state,
                                                      const std::vector<Candidate>& candidates,
                                                      const std::vector<Column>& columns,
                                                      const Prediction& base);

/// Columns of what may differ from run to run: friction left, right, resistance left, right, gyro's
/// bias, standby power.
[[nodiscard]] std::vector<Eigen::MatrixXd> run_signatures(const RunSignals& signals, const Robot& robot,
                                                          const Prediction& base);
[[nodiscard]] Eigen::VectorXd run_start_variance(const Robot& robot);

}  // namespace joulepath
