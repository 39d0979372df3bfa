#include "app/report/diagnosis_report.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "diagnosis/prediction/prediction.hpp"
#include "model/kinematics.hpp"

namespace joulepath::report {
namespace {

constexpr std::size_t kMostRuns = 40;

std::vector<double> values_of(const Eigen::VectorXd& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

bool is_measured(const Columns::value_type& column) { return column.first.starts_with("measured_"); }

/// Measured and predicted columns of one run, signal by signal.
class Comparison {
 public:
  Comparison(const RunSignals& signals, Prediction predicted, std::optional<Prediction> corrected)
      : signals_(signals), predicted_(std::move(predicted)), corrected_(std::move(corrected)) {
    columns_["time_s"] = values_of(signals.time_s);
  }

  /// `of(prediction)` is what a model says of a signal.
  template <class Of>
  void add(const std::string& name, const Eigen::VectorXd& measured, const Of& of) {
    if (measured.size() != signals_.size()) return;
    columns_["measured_" + name] = values_of(measured);
    columns_["predicted_" + name] = values_of(of(predicted_));
    if (corrected_) columns_["corrected_" + name] = values_of(of(*corrected_));
  }

  /// Changes since the start of the run: where it began is no business of the model.
  void add_change(const std::string& name, const Eigen::VectorXd& measured,
                  Eigen::VectorXd Prediction::*predicted) {
    if (measured.size() == 0) return;
    const auto since_start = [](const Eigen::VectorXd& v) { return Eigen::VectorXd(v.array() - v[0]); };
    add(name, since_start(measured), [&](const Prediction& p) { return since_start(p.*predicted); });
  }

  /// What the motion was, to show what a difference depends on.
  void add_motion(const Geometry& geometry) {
    for (Eigen::Index j = 0; j < signals_.size(); ++j) {
      const auto at = [&](const Sided<Eigen::VectorXd>& wheel) {
        return body_twist(geometry, Sided<double>{wheel.left[j], wheel.right[j]});
      };
      const Twist<double> twist = at(signals_.wheel_speed_rad_s),
                          rate = at(signals_.wheel_acceleration_rad_s2);
      columns_["motion_speed_m_s"].push_back(twist.speed_m_s);
      columns_["motion_acceleration_m_s2"].push_back(rate.speed_m_s);
      columns_["motion_yaw_rate_rad_s"].push_back(twist.yaw_rate_rad_s);
    }
    columns_["motion_payload_kg"] = values_of(signals_.payload_kg);
  }

  [[nodiscard]] Columns columns() && { return std::move(columns_); }

 private:
  const RunSignals& signals_;
  Prediction predicted_;
  std::optional<Prediction> corrected_;
  Columns columns_{};
};

Columns compared(const RunSignals& run, const ModelPoint& nominal,
                 const std::optional<ModelPoint>& corrected) {
  std::optional<Prediction> after;
  if (corrected) after = predict(run, *corrected);
  Comparison all(run, predict(run, nominal), std::move(after));
  if (run.motor_power_W.left.size() > 0 && run.motor_power_W.right.size() > 0)
    all.add("motor_power_W", Eigen::VectorXd(run.motor_power_W.left + run.motor_power_W.right),
            [](const Prediction& p) { return Eigen::VectorXd(p.power_W.left + p.power_W.right); });
  for (const Side side : kSides) {
    const std::string wheel = std::string("_") + side_name(side);
    all.add("motor_current" + wheel + "_A", run.motor_current_A[side],
            [&](const Prediction& p) { return p.current_A[side]; });
    all.add("motor_voltage" + wheel + "_V", run.motor_voltage_V[side],
            [&](const Prediction& p) { return p.voltage_V[side]; });
  }
  const auto member = [](Eigen::VectorXd Prediction::*field) {
    return [field](const Prediction& p) { return p.*field; };
  };
  all.add("battery_power_W", run.battery_power_W, member(&Prediction::battery_power_W));
  if (run.battery_current_A.size() > 0)
    all.add("battery_voltage_V", run.battery_voltage_V, member(&Prediction::battery_voltage_V));
  all.add("yaw_rate_rad_s", run.gyro_yaw_rate_rad_s, member(&Prediction::yaw_rate_rad_s));
  if (run.heading_measured)
    all.add_change("change_of_heading_rad", run.heading_rad, &Prediction::heading_rad);
  all.add_change("change_of_x_m", run.x_m, &Prediction::x_m);
  all.add_change("change_of_y_m", run.y_m, &Prediction::y_m);
  all.add_motion(nominal.robot.geometry);
  return std::move(all).columns();
}

}  // namespace

std::vector<RunComparison> run_comparisons(const Diagnosis& diagnosis, const Dataset& dataset) {
  const SimulatorGap& simulator = diagnosis.simulator;
  const ModelPoint nominal{.robot = simulator.runs > 0 ? simulator.robot : dataset.robot};
  std::optional<ModelPoint> corrected;
  if (diagnosis.corrected_robot || !diagnosis.corrected_instruments.empty())
    corrected = ModelPoint{.robot = diagnosis.corrected_robot.value_or(nominal.robot),
                           .effects = diagnosis.corrected_instruments};
  std::vector<RunComparison> runs;
  for (std::size_t k = 0; k < dataset.runs.size() && runs.size() < kMostRuns; ++k) {
    if (!has_usable_log(dataset.runs[k]) || (simulator.runs > 0 && !simulator.deviations.contains(k)))
      continue;
    Run run = dataset.runs[k];
    if (simulator.runs > 0) run.deviation = simulator.deviations.at(k);
    run.velocity_filter_s = diagnosis.velocity_filter_s;
    RunSignals signals = make_run_signals(run, k, nominal.robot);
    if (const auto estimated = diagnosis.estimated_payload_kg.find(k);
        estimated != diagnosis.estimated_payload_kg.end())
      signals.payload_kg.setConstant(estimated->second);
    const bool is_validation = std::ranges::count(diagnosis.validation_runs, signals.name) > 0;
    Columns columns = compared(signals, nominal, corrected);
    if (std::ranges::any_of(columns, is_measured))
      runs.push_back({signals.name, is_validation ? "validation" : "diagnosis", std::move(columns)});
  }
  // Held-out runs come first.
  std::stable_partition(runs.begin(), runs.end(),
                        [](const RunComparison& run) { return run.use == "validation"; });
  return runs;
}

std::string diagnosis_report(const Diagnosis& diagnosis, const std::string& diagnosis_json,
                             const Dataset& dataset) {
  DiagnosisExtras extras;
  extras.title = std::filesystem::path(dataset.file).filename().string();
  extras.subtitle = dataset.robot.name;
  extras.runs = run_comparisons(diagnosis, dataset);
  return diagnosis_report_html(nlohmann::json::parse(diagnosis_json), extras);
}

}  // namespace joulepath::report
