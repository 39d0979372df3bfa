// The benchmark of the source paper [P1]: every table and figure, computed and printed.
//   bench_paper SCENARIO_FOLDER RESULTS_FOLDER "HEADER LINE"
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "benchmarks/paper/sections.hpp"
#include "scenarios/log_files/dataset_file.hpp"

namespace joulepath::bench {
namespace {

void parameters_rows(PaperReport& report) {
  report.summary.push_back(
      {"Table 2", "not possible", "", "", "its content is not among the figures known to us"});
  report.summary.push_back(
      {"Table 3", "consistent", "used as printed", "motor constants",
       "inputs; the printed unit of Kv is inverted; n, I_w, I_s, I_c, I_m are not printed"});
}

void figures_without_numbers(PaperReport& report) {
  report.summary.push_back({"Figs. 3, 4", "not possible", "runs in scenarios/paper/calibration_runs.yaml",
                            "curves only",
                            "energy against speed at constant speeds: no printed number to compare with"});
  report.summary.push_back({"Fig. 5", "consistent", "repeated 4 s ramps",
                            "\"several accelerations of 0.2 m/s^2\"",
                            "the reason for Table 4's repeated ramps; the curve itself is not available"});
  report.summary.push_back({"Figs. 7, 8, 9, 11", "not possible", "plots below", "curves only",
                            "no printed number of them is known to us"});
}

std::string summary_text(const PaperReport& report) {
  std::string out = "| item | status | ours | printed | note |\n|---|---|---|---|---|\n";
  for (const SummaryRow& row : report.summary)
    out += "| " + row.item + " | " + row.status + " | " + row.ours + " | " + row.printed + " | " + row.note +
           " |\n";
  return out;
}

int run(const std::string& scenarios, const std::string& results, const std::string& header) {
  PaperReport report;
  report.plots_folder = results + "/paper";
  std::filesystem::create_directories(report.plots_folder);
  report.straight = read_dataset(scenarios + "/straight_measured.yaml");
  report.bezier = read_dataset(scenarios + "/bezier_measured.yaml");
  report.robot = report.straight.robot;

  parameters_rows(report);
  coefficients_section(report);
  straight_section(report);
  bezier_section(report);
  figures_without_numbers(report);
  turning_inertia_section(report);
  offset_section(report);
  planning_cost_section(report);

  std::ofstream out(results + "/paper.md");
  out << "# The source paper, reproduced\n\n"
      << header << "\n\n"
      << "[P1]: Jaramillo-Morales, Dogru, Gomez-Mendoza, Marques (2020), doi 10.1177/1729881420909654. "
         "Status: "
         "*reproduced* = the printed figure comes out of printed inputs alone; *consistent* = it comes out "
         "under a "
         "stated and partly fitted hypothesis; *not reproduced* = no hypothesis tried gives it; *not "
         "possible* = there "
         "is no figure to compare with. Energy error = (estimated - measured)/measured, sum of both "
         "wheels.\n\n"
      << summary_text(report) << "\n"
      << report.text;
  if (!out.flush()) throw std::runtime_error("cannot write " + results + "/paper.md");
  std::printf("%s\n%s/paper.md\n", summary_text(report).c_str(), results.c_str());
  return 0;
}

}  // namespace
}  // namespace joulepath::bench

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bench_paper SCENARIO_FOLDER RESULTS_FOLDER HEADER\n");
    return 2;
  }
  try {
    return joulepath::bench::run(argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_paper: %s\n", error.what());
    return 1;
  }
}
