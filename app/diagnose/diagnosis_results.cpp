#include "app/diagnose/diagnosis_results.hpp"

#include <nlohmann/json.hpp>

#include "app/diagnose/changed_simulator.hpp"
#include "app/report/diagnosis_report.hpp"
#include "scenarios/log_files/repaired_dataset.hpp"
#include "scenarios/result_files/decision_cost.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {

DiagnosisResults diagnosis_results(Dataset dataset, DiagnoseOptions options, const Document* document) {
  options.refusal = refusal_of;
  DiagnosisResults results{.dataset = std::move(dataset)};
  Diagnosis& diagnosis = results.diagnosis = diagnose(results.dataset, options);
  if (document)
    describe_repairs(results.dataset, *document, diagnosis.data_checks);
  else
    describe_repairs(results.dataset, diagnosis.data_checks);
  if (diagnosis.corrected_robot) {
    const DecisionCost cost =
        decision_cost(diagnosis.simulator.runs > 0 ? diagnosis.simulator.robot : results.dataset.robot,
                      *diagnosis.corrected_robot);
    diagnosis.decision_missions = cost.missions;
    diagnosis.joules_lost_percent = cost.joules_lost_percent;
  }
  results.json = diagnosis_json(diagnosis);
  if (diagnosis.simulator.runs > 0) results.json = with_compared_logs(results.json, results.dataset);
  return results;
}

std::string DiagnosisResults::report() const { return report::diagnosis_report(diagnosis, json, dataset); }

std::string DiagnosisResults::json_with_signals() const {
  nlohmann::ordered_json with = nlohmann::ordered_json::parse(json);
  with["signals"] = report::runs_json(report::run_comparisons(diagnosis, dataset));
  return with.dump(2) + "\n";
}

}  // namespace joulepath
