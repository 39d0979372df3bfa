#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnosis/values/verdict.hpp"
#include "tests/app/report/sample_data.hpp"

namespace joulepath::report {
namespace {

nlohmann::json embedded_data(const std::string& html) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const auto from = html.find(open) + open.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

TEST(Report, HoldsItsDataUnchanged) {
  const auto data = embedded_data(plan_report_html(sample::plan(), sample::trajectory()));
  EXPECT_EQ(data.at("plan"), sample::plan());
  EXPECT_EQ(data.at("trajectory").at("time_s").size(), sample::trajectory().at("time_s").size());
}

TEST(Report, TheTitleNamesKindMissionRobotDayAndVersion) {
  ::setenv("SOURCE_DATE_EPOCH", "86400", 1);
  const std::string html =
      plan_report_html(sample::plan(), {}, {.title = "round", .subtitle = "robot · map.yaml"});
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_NE(html.find("<title>Plan · round · robot · map.yaml · 1970-01-02 · joulepath "), std::string::npos);
}

/// A page holds the ends of the interval, and none where nothing is stated.
TEST(Report, BandsAreNinetyFivePercentOfTheirSigmas) {
  PlanExtras extras;
  EXPECT_FALSE(
      embedded_data(plan_report_html(sample::plan(), sample::trajectory(), extras)).contains("bands"));
  extras.bands.energy_J = PlanBand{{0.0, 1.0}, {0.0, 10.0}, {0.0, 1.0}};
  const auto bands =
      embedded_data(plan_report_html(sample::plan(), sample::trajectory(), extras)).at("bands");
  EXPECT_EQ(bands.size(), 1u);
  EXPECT_NEAR(bands.at("energy_J").at("low")[1], 10 - 1.96, 1e-3);
  EXPECT_NEAR(bands.at("energy_J").at("high")[1], 10 + 1.96, 1e-3);
}

TEST(Report, NamesThatLookLikeMarkupCannotCloseTheScript) {
  auto plan = sample::plan();
  plan["legs"][0]["to"] = "</script><script>alert(1)</script><!--";
  const std::string html = plan_report_html(plan, {}, {.title = "</title><b>"});
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("</title><b>"), std::string::npos);
  EXPECT_EQ(embedded_data(html).at("plan").at("legs")[0].at("to"), plan["legs"][0]["to"]);
}

TEST(Report, AtSignsInDataAreNotPlaceholders) {
  auto plan = sample::plan();
  plan["legs"][0]["to"] = "@SCRIPT@ @DATA@";
  EXPECT_EQ(embedded_data(plan_report_html(plan, {})).at("plan"), plan);
}

TEST(Report, OfADiagnosisCarriesTheWordsOfEachVerdict) {
  for (const VerdictWords& words : kVerdicts) {
    auto diagnosis = sample::diagnosis();
    diagnosis["verdict"] = words.name;
    const auto data = embedded_data(diagnosis_report_html(diagnosis, {}));
    EXPECT_EQ(data.at("verdict").at("title"), words.title);
    EXPECT_EQ(data.at("verdict").at("meaning"), words.meaning);
    EXPECT_EQ(data.at("verdict").at("good"), words.good);
  }
}

TEST(Report, FetchesNothing) {
  const std::string html =
      diagnosis_report_html(sample::diagnosis(), {"", "", map_picture(sample::hall()), sample::runs()});
  for (const char* fetch :
       {"<script src", "<link rel=\"stylesheet\"", "@import", "url(http", "fetch(", "<img src=\"http"})
    EXPECT_EQ(html.find(fetch), std::string::npos) << fetch;
}

TEST(Report, WithoutScriptsItsNumbersStandInTables) {
  auto plan = sample::plan();
  plan["legs"][0]["to"] = "<b>shelf</b>";
  const std::string html = plan_report_html(plan, sample::trajectory());
  const auto from = html.find("<noscript>"), to = html.find("</noscript>");
  const std::string text = html.substr(from, to - from);
  EXPECT_NE(text.find("<th scope=\"row\">energy J</th>"), std::string::npos);
  EXPECT_NE(text.find("<td>&lt;b>shelf&lt;/b></td>"), std::string::npos);
  EXPECT_NE(text.find("<th scope=\"col\">duration s</th>"), std::string::npos);
  EXPECT_EQ(text.find("<script"), std::string::npos);
}

TEST(Report, WithoutScriptsACauseHasItsSizeAndInterval) {
  const std::string html = diagnosis_report_html(sample::diagnosis(), {});
  const auto from = html.find("<noscript>"), to = html.find("</noscript>");
  const std::string text = html.substr(from, to - from);
  EXPECT_NE(text.find("coefficient, interval 95 0.0152, 0.0166, value 0.0159"), std::string::npos) << text;
  EXPECT_NE(text.find("<th scope=\"col\">probability told apart</th>"), std::string::npos);
}

TEST(Report, SignalsOfManyRunsStaySmall) {
  RunComparison run{"run", "diagnosis", {}};
  for (const char* name : {"time_s", "measured_motor_power_W", "predicted_motor_power_W"})
    for (int k = 0; k < 20'000; ++k) run.columns[name].push_back(0.01 * k);
  const auto list = runs_json(std::vector<RunComparison>(40, run), 50'000);
  std::size_t numbers = 0;
  for (const auto& one : list)
    for (const auto& column : one.at("columns")) numbers += column.size();
  EXPECT_LT(numbers, 60'000U);
  EXPECT_EQ(list[0].at("columns").at("time_s").back(), 0.01 * 19'999);
}

TEST(Report, SameInputGivesSameBytes) {
  EXPECT_EQ(front_report_html(sample::front(), {}), front_report_html(sample::front(), {}));
}

TEST(Report, NumbersThatAreNotFiniteBecomeGaps) {
  Columns columns{{"time_s", {0.0, 1.0}}, {"linear_speed_m_s", {0.0, std::nan("")}}};
  EXPECT_TRUE(embedded_data(plan_report_html(sample::plan(), columns))
                  .at("trajectory")
                  .at("linear_speed_m_s")[1]
                  .is_null());
}

TEST(Report, StaysUnderThreeMegabytesForAnHourAtFiftyHertz) {
  Columns hour = sample::trajectory(0.02);
  const auto once = hour;
  while (hour["time_s"].size() < 180'000)
    for (auto& [name, values] : hour) values.insert(values.end(), once.at(name).begin(), once.at(name).end());
  for (std::size_t k = 0; k < hour["time_s"].size(); ++k) hour["time_s"][k] = 0.02 * static_cast<double>(k);
  OccupancyGrid noise = sample::hall();
  noise.width = 2000;
  noise.height = 1000;
  noise.occupancy_percent.assign(2'000'000, 0);
  PlanExtras extras{.map = map_picture(noise), .overlays = {{"trapezoid", hour}, {"s_curve", hour}}};
  EXPECT_LT(plan_report_html(sample::plan(), hour, extras).size(), 3'000'000U);
}

TEST(Report, BatchOfFiftyThousandStaysSmallAndCountsAll) {
  nlohmann::json missions = nlohmann::json::array();
  const nlohmann::json one = sample::batch().at("missions")[3],
                       failed = sample::batch().at("missions").back();
  for (int k = 0; k < 50'000; ++k) missions.push_back(k % 10 == 0 ? failed : one);
  const std::string html = batch_report_html({{"missions", missions}});
  EXPECT_LT(html.size(), 3'000'000U);
  const auto data = embedded_data(html).at("batch");
  EXPECT_EQ(data.at("status"), nlohmann::json({{"optimal", 45'000}, {"infeasible", 5'000}}));
  EXPECT_NEAR(data.at("total").at("energy_J").get<double>(), 45'000 * one.at("energy_J").get<double>(), 1e-3);
}

TEST(Report, BatchNamesTheMissionWithTheMostJoulesPerMeterFirst) {
  const auto worst = embedded_data(batch_report_html(sample::batch())).at("batch").at("worst");
  double before = 1e300;
  for (const auto& mission : worst) {
    const double per_meter = mission.at("energy_J").get<double>() / mission.at("distance_m").get<double>();
    EXPECT_LE(per_meter, before);
    before = per_meter;
  }
  EXPECT_EQ(worst.size(), 40U);
}

TEST(Thinning, KeepsOrderEndsAndPeaks) {
  Columns columns;
  for (int k = 0; k < 10'000; ++k) {
    columns["time_s"].push_back(k);
    columns["linear_speed_m_s"].push_back(k == 4321 ? 9.0 : std::sin(0.01 * k));
    columns["battery_power_W"].push_back(k == 8765 ? -50.0 : 1.0);
  }
  const auto thin = thinned(columns, 1000);
  const auto& time = thin.at("time_s");
  EXPECT_LE(time.size(), 1100U);
  EXPECT_GE(time.size(), 200U);
  EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
  EXPECT_EQ(time.front(), 0.0);
  EXPECT_EQ(time.back(), 9999.0);
  EXPECT_EQ(std::ranges::max(thin.at("linear_speed_m_s")), 9.0);
  EXPECT_EQ(std::ranges::min(thin.at("battery_power_W")), -50.0);
}

TEST(MapPicture, RunsCoverEveryCellAndCoarseningKeepsWalls) {
  OccupancyGrid grid{301, 203, 0.05, {0, 0, 0}, std::vector<std::int8_t>(301 * 203, 0), ""};
  for (int row = 0; row < 203; ++row) grid.occupancy_percent[static_cast<std::size_t>(row * 301 + 150)] = 100;
  const auto picture = map_picture(grid, nullptr, 5000);
  EXPECT_LE(picture.width * picture.height, 5000);
  int covered = 0, occupied = 0;
  for (const auto& [cell, count] : picture.runs) {
    covered += count;
    if (cell == MapPicture::occupied) occupied += count;
  }
  EXPECT_EQ(covered, picture.width * picture.height);
  EXPECT_EQ(occupied, picture.height);
}

TEST(MapPicture, KeepOutShowsOnFreeFloorOnly) {
  OccupancyGrid grid{4, 1, 1.0, {0, 0, 0}, {0, 100, 0, kUnknownCell}, ""};
  const OccupancyGrid mask{2, 1, 1.0, {0, 0, 0}, {100, 100}, ""};
  const std::vector<std::pair<MapPicture::Cell, int>> expected{
      {MapPicture::keep_out, 1}, {MapPicture::occupied, 1}, {MapPicture::free, 1}, {MapPicture::unknown, 1}};
  EXPECT_EQ(map_picture(grid, &mask).runs, expected);
}

}  // namespace
}  // namespace joulepath::report
