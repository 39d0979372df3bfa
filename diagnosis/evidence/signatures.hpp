#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "diagnosis/evidence/equations.hpp"

namespace joulepath {

/// Position of a candidate's amplitudes in a state, and the interval from `low` to `high` for the finite
/// difference of one amplitude (`low` is 0 where physics allows no negative value).
struct AmplitudeStep {
  std::vector<double> value{};
  double low{};
  double high{};
};
[[nodiscard]] AmplitudeStep amplitude_step(const ModelState& state, const Candidate& candidate,
                                           std::size_t part);

/// The state with that amplitude changed; adds the candidate where the state lacks it.
[[nodiscard]] ModelState with_change(const ModelState& state, const Candidate& candidate,
                                     const AmplitudeStep& step, std::size_t part, double change);

/// Variables on which the strength of a law may depend beyond its textbook form: one form column each.
inline constexpr std::array<std::string_view, 5> kFormVariables{"speed", "yaw rate", "payload",
                                                                "acceleration", "time of day"};

/// Columns of the linear problem at a state, without rows: nuisances, candidates, shapes of the state's
/// effects, forms, dictionary. The part of a form is its variable, then variable by variable for each
/// further amplitude.
[[nodiscard]] std::vector<Column> list_columns(const std::vector<Nuisance>& nuisances,
                                               const ModelState& state,
                                               const std::vector<Candidate>& candidates,
                                               std::size_t dictionary_entries, Forms forms);

/// d(structured rows)/d(parameter) of nuisances, amplitudes and shapes, each samples x kChannelCount: central
/// differences of noise-free predictions.
[[nodiscard]] std::vector<Eigen::MatrixXd> signatures(const RunSignals& signals, const Robot& robot,
                                                      const std::vector<Nuisance>& nuisances,
                                                      const ModelState& state,
                                                      const std::vector<Candidate>& candidates,
                                                      const std::vector<Column>& columns,
                                                      const Prediction& base);

/// Columns of the parameters that may differ between runs: friction and resistance (left, right), bias of the
/// gyro, standby power; then the battery's open-circuit voltage at the run's start, and its change by the
/// charge that the run draws.
[[nodiscard]] std::vector<Eigen::MatrixXd> run_signatures(const RunSignals& signals, const Robot& robot,
                                                          const Prediction& base);
[[nodiscard]] Eigen::VectorXd run_start_variance(const Robot& robot);
/// The last of them are given, not estimated: a battery is at another charge in every run.
inline constexpr Eigen::Index kGivenRunVariances = 2;

/// Column of a payload (kg) that no file states: a further parameter of the run. Zero for a stated one.
[[nodiscard]] Eigen::MatrixXd payload_signature(const RunSignals& signals, const ModelPoint& point,
                                                const Prediction& base);
/// Prior width of such a payload: the robot's limit, or a share of its mass.
[[nodiscard]] double payload_prior_sd_kg(const Robot& robot);

}  // namespace joulepath
