// Writes one report of each kind into a folder, for the browser test and for inspection.
#include <fstream>
#include <iostream>

#include "tests/app/report/sample_data.hpp"

int main(int argc, char** argv) {
  using namespace joulepath::report;
  if (argc != 2) {
    std::cerr << "usage: report_samples FOLDER\n";
    return 2;
  }
  const std::string folder = argv[1];
  const auto write = [&](const std::string& name, const std::string& html) {
    std::ofstream(folder + "/" + name + ".html") << html;
  };
  const auto map = map_picture(sample::hall());
  joulepath::Limits limits;
  limits.speed_m_s = 1.0;
  limits.acceleration_m_s2 = limits.deceleration_m_s2 = 0.5;
  PlanExtras extras{"Sample round", "made-up data", map, limits, {sample::profiles().back()}};
  write("exact", plan_report_html(sample::plan(), sample::trajectory(), extras));
  extras.bands = sample::bands();
  extras.operation = {.missions_per_day = 40, .price_per_kWh = 0.3};
  write("plan", plan_report_html(sample::plan(), sample::trajectory(), extras));
  write(
      "infeasible",
      plan_report_html(
          sample::infeasible_plan(), {},
          {.title = "Sample round", .subtitle = "made-up data", .map = map, .stations = sample::stations()}));
  write("diagnosis",
        diagnosis_report_html(sample::diagnosis(), {"Sample runs", "made-up data", map, sample::runs()}));
  const MissionExtras mission{
      "Sample round", "made-up data", map, sample::trajectory(), {"shelf <3> & co", "dock"}};
  write("compare", compare_report_html(sample::compare(), sample::profiles(), mission));
  write("loss", compare_report_html({{"loss", sample::loss()}}, sample::loss_motions(), mission));
  write("front", front_report_html(sample::front(), mission));
  write("batch", batch_report_html(sample::batch()));
}
