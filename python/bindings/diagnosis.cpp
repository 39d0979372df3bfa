#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/diagnose/diagnosis_results.hpp"
#include "app/diagnose/left_out_effects.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/robot.hpp"
#include "python/bindings/stop.hpp"
#include "scenarios/log_files/corrected_dataset.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath::python {
namespace {

using Tables = std::map<std::string, CsvTable>;

/// A table of columns of equal length, as a CSV file of them would give.
CsvTable table_of(const std::string& name, const std::map<std::string, Numbers>& columns) {
  CsvTable table{.file = name};
  for (const auto& [header, values] : columns) {
    table.header.push_back(header);
    table.columns.push_back(vector_of(values));
  }
  return table;
}

/// Options of the `diagnose` command: suspect channels lead to a verdict, not to an error.
constexpr ReadOptions kReading{.cut_long_logs = true, .accept_implausible = true};

DiagnosisResults diagnose_text(const std::string& text, const std::string& name, const RobotValue& robot,
                               const std::map<std::string, std::map<std::string, Numbers>>& frames,
                               const std::vector<std::string>& without, nb::handle progress) {
  const DiagnoseOptions options{.without = left_out_effects(without)};
  Tables logs;
  for (const auto& [log, columns] : frames) logs[log] = table_of(log, columns);
  LongCall call(progress);
  const Document document = from_object(name, [&] { return Document::parse(text, name); });
  Dataset dataset = from_objects(
      [&](const std::string& file) { return file == name || logs.contains(file); },
      [&] { return dataset_from(document, kReading, {}, {.robot = &robot.robot, .logs = &logs}); });
  dataset.file.clear();  // without a file, no corrected dataset can be written
  DiagnosisResults results = diagnosis_results(std::move(dataset), options, &document);
  call.finish();
  return results;
}

DiagnosisResults diagnose_file(const std::string& file, const RobotValue* robot,
                               const std::vector<std::string>& without, nb::handle progress) {
  const DiagnoseOptions options{.without = left_out_effects(without)};
  LongCall call(progress);
  const Document document = Document::load(file);
  DiagnosisResults results = diagnosis_results(
      dataset_from(document, kReading, {}, {.robot = robot ? &robot->robot : nullptr}), options, &document);
  call.finish();
  return results;
}

std::optional<std::string> corrected_dataset(const DiagnosisResults& self, const std::string& directory) {
  if (self.diagnosis.corrected_instruments.empty() || self.dataset.file.empty()) return {};
  return corrected_dataset_text(self.dataset, self.diagnosis.corrected_instruments, directory);
}

}  // namespace

void bind_diagnosis(nb::module_& module) {
  nb::class_<DiagnosisResults>(module, "DiagnosisValue", "A diagnosis with its output files.")
      .def_prop_ro(
          "json", [](const DiagnosisResults& self) { return self.json; }, "diagnosis.json")
      .def(
          "report", [](const DiagnosisResults& self) { return self.report(); }, "report.html")
      .def("robot",
           [](const DiagnosisResults& self) {
             const auto& robot = self.diagnosis.corrected_robot;
             return robot ? std::optional<RobotValue>(RobotValue{*robot}) : std::nullopt;
           })
      .def("corrected_dataset", &corrected_dataset, nb::arg("directory"));
  module.def("diagnose_text", &diagnose_text, nb::arg("text"), nb::arg("name"), nb::arg("robot"),
             nb::arg("frames"), nb::arg("without"), nb::arg("progress").none());
  module.def("diagnose_file", &diagnose_file, nb::arg("file"), nb::arg("robot").none(), nb::arg("without"),
             nb::arg("progress").none());
}

}  // namespace joulepath::python
