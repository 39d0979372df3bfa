#include "app/report/diagnosis_report.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "diagnosis/prediction/prediction.hpp"

namespace joulepath::report {
namespace {

constexpr std::size_t kMostRuns = 40;

std::vector<double> values_of(const Eigen::VectorXd& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

std::vector<double> both_wheels(const Sided<Eigen::VectorXd>& power_W) {
  const Eigen::VectorXd sum = power_W.left + power_W.right;
  return values_of(sum);
}

RunComparison compared(const RunSignals& signals, const ModelPoint& nominal, const ModelPoint& corrected,
                       bool is_validation, bool is_corrected) {
  return {.name = signals.name,
          .use = is_validation ? "validation" : "diagnosis",
          .time_s = values_of(signals.time_s),
          .measured_power_W = both_wheels(signals.motor_power_W),
          .predicted_power_W = both_wheels(predict(signals, nominal).power_W),
          .corrected_power_W =
              is_corrected ? both_wheels(predict(signals, corrected).power_W) : std::vector<double>{}};
}

}  // namespace

std::string diagnosis_report(const Diagnosis& diagnosis, const std::string& diagnosis_json,
                             const Dataset& dataset) {
  const ModelPoint nominal{.robot = dataset.robot};
  const ModelPoint corrected{.robot = diagnosis.corrected_robot.value_or(dataset.robot),
                             .effects = diagnosis.corrected_instruments};
  const bool is_corrected = diagnosis.corrected_robot || !diagnosis.corrected_instruments.empty();
  DiagnosisExtras extras;
  extras.title = std::filesystem::path(dataset.file).filename().string();
  for (std::size_t k = 0; k < dataset.runs.size() && extras.runs.size() < kMostRuns; ++k) {
    if (!has_usable_log(dataset.runs[k])) continue;
    const RunSignals signals = make_run_signals(dataset.runs[k], k, dataset.robot);
    if (signals.motor_power_W.left.size() == 0 || signals.motor_power_W.right.size() == 0) continue;
    const bool is_validation = std::ranges::count(diagnosis.validation_runs, signals.name) > 0;
    extras.runs.push_back(compared(signals, nominal, corrected, is_validation, is_corrected));
  }
  // Held-out runs come first.
  std::stable_partition(extras.runs.begin(), extras.runs.end(),
                        [](const RunComparison& run) { return run.use == "validation"; });
  return diagnosis_report_html(nlohmann::json::parse(diagnosis_json), extras);
}

}  // namespace joulepath::report
