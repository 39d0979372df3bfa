#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/plan/plan_analysis.hpp"
#include "app/plan/plan_options.hpp"
#include "app/plan/plan_summary.hpp"
#include "app/report/plan_report.hpp"
#include "app/terminal.hpp"
#include "model/progress.hpp"
#include "planner/baselines/comparison.hpp"
#include "planner/confidence/confident_plan.hpp"
#include "planner/confidence/margins.hpp"
#include "planner/legs/on_ways.hpp"
#include "planner/mission/mission.hpp"
#include "planner/mission/mission_time.hpp"
#include "planner/mission/plan_front.hpp"
#include "scenarios/mission_files/mission_file.hpp"

namespace joulepath {
namespace {

nlohmann::json point_json(const FrontPoint& point, double accuracy) {
  nlohmann::json result = {{"duration_s", point.duration_s},
                           {"energy_J", point.energy_J},
                           {"motion_energy_J", point.motion_energy_J},
                           {"status", solve_status_name(point.status(accuracy))},
                           {"optimality_gap_percent", point.gap_percent()}};
  result["price_of_time_W"] =
      std::isfinite(point.price_of_time_W) ? nlohmann::json(point.price_of_time_W) : nlohmann::json(nullptr);
  return result;
}

bool have_several_ways(const std::vector<FrontPoint>& points) {
  return std::any_of(points.begin(), points.end(), [](const FrontPoint& point) { return point.drive > 0; });
}

/// Points tell their ways where these are several.
nlohmann::json points_json(const std::vector<FrontPoint>& points, double accuracy) {
  nlohmann::json result = nlohmann::json::array();
  for (const FrontPoint& point : points) {
    result.push_back(point_json(point, accuracy));
    if (have_several_ways(points)) result.back()["ways"] = point.ways;
  }
  return result;
}

class FrontCommand : public Command {
 public:
  FrontCommand()
      : Command(
            {.name = "front",
             .says = "compute the least energy for each duration of a mission or a path, with exact slopes",
             .examples = "  joulepath front scenarios/missions/warehouse_pick.yaml --points 30\n"
                         "  joulepath front mission.yaml --out out/front   # front.json and report.html\n"
                         "  joulepath front path.csv --robot robot.yaml --payload 5\n"}) {}

  void declare(CommandLine& line) override {
    add_analysis_options(line, options_, kResult, false);
    line.option("--points", points_,
                "points of the front; deadlines and durations are ignored, except where slower is always "
                "cheaper: there they end it")
        .between(2, 2000)
        .shows_default();
    line.option("--baselines", baseline_points_, "points with classic profiles for comparison; 0: none")
        .between(0, 2000)
        .shows_default();
    add_plan_options(line, options_.plan, "nodes on each stretch");
    add_confidence(line, confidence_);
  }

  int run() override {
    OutputDirectory out = analysis_output(options_, kResult);
    const ReadOptions reading{.untrusted = options_.common.untrusted};
    MissionRequest mission = read_told_source(options_.source, reading, options_.common.quiet);
    if (confidence_) mission.objective.confidence = confidence_;
    confidence_ = mission.objective.confidence;
    const MissionWorld world = read_told_world(mission, reading, options_.common.quiet);
    const bool open = slower_is_always_cheaper(mission, world);
    drop_times(mission, open);
    expect_steps(points_ + std::min(points_, baseline_points_));
    const auto [plans, front] = mission_front(mission, world, options_.plan, points_, open);
    const Plan& plan = plans.front();
    if (!is_driven(plan)) {
      std::cerr << "no front: " << plan.message << "\n";
      return kInfeasibleOrFailed;
    }
    if (front.points.empty()) {
      const std::string& why = front.summary.message;
      std::cerr << "no front: " << (why.empty() ? "the mission has no stretch to optimize" : why) << "\n";
      return kInfeasibleOrFailed;
    }
    std::optional<SureFront> sure;
    if (confidence_) {
      sure = sure_front(mission, world, open);
      if (!sure->reason.empty()) {
        std::cerr << "no front: " << sure->reason << "\n";
        return kInfeasibleOrFailed;
      }
    }
    std::vector<Beside> beside;
    for (std::size_t k : chosen(front.points.size(), baseline_points_))
      beside.push_back({k, baselines_at(front.points[k], plans[front.points[k].drive])});
    const auto extras = writes_analysis(options_) ? report::mission_extras(plan, mission, world)
                                                  : report::MissionExtras{.title = mission.name};
    show(front, sure, beside, extras, out);
    return kDone;
  }

 private:
  /// Where it is, the mission's times stay: a front without a slow end has no cheapest point.
  static bool slower_is_always_cheaper(MissionRequest mission, const MissionWorld& world) {
    drop_times(mission, false);
    return first_price_W(mission, world, make_plant(world.robot)) > 0;
  }

  static void drop_times(MissionRequest& mission, bool keep_times) {
    mission.objective = {.deadline_s = keep_times ? mission.objective.deadline_s : std::nullopt,
                         .marks = mission.objective.marks};
    if (keep_times) return;
    for (LegRequest& leg : mission.legs) {
      leg.deadline_s.reset();
      leg.duration_s.reset();
    }
  }

  /// The front of a mission with the margins of its fastest drive that keeps the confidence.
  struct SureFront {
    LimitShares limit_shares{};
    double reserve_margin{};
    std::vector<FrontPoint> points{};
    std::map<std::size_t, KeptShare> judged{};  ///< by the index of the point
    std::string reason{};                       ///< reason why there is none
  };

  SureFront sure_front(const MissionRequest& mission, const MissionWorld& world, bool open) const {
    MissionRequest fastest = mission;
    fastest.objective.minimize = Objective::Minimize::time;
    fastest.objective.confidence = confidence_;
    const Plan held = plan_mission(fastest, world, options_.plan);
    if (!is_driven(held)) return {.reason = held.message};
    expect_steps(points_);
    SureFront sure{.limit_shares = held.confidence->limit_shares,
                   .reserve_margin = held.confidence->reserve_margin};
    MissionWorld careful = world;
    careful.robot = with_margins(std::move(careful.robot), sure.limit_shares, sure.reserve_margin);
    const MissionFront all =
        mission_front(mission, careful, with_limit_shares(options_.plan, sure.limit_shares), points_, open);
    if (!is_driven(all.plans.front())) return {.reason = all.plans.front().message};
    sure.points = all.front.points;
    for (const std::size_t k : chosen(sure.points.size(), kJudged))
      if (auto account = judged(all.plans[sure.points[k].drive], mission, world, careful, sure,
                                sure.points[k].duration_s))
        sure.judged[k] = *account;
    return sure;
  }

  /// What draws of the robot say of a sure front's plan in a time; none where it cannot be driven with the
  /// front's margins, as with stops at chargers.
  std::optional<KeptShare> judged(const Plan& plan, const MissionRequest& mission, const MissionWorld& world,
                                  const MissionWorld& careful, const SureFront& sure,
                                  double duration_s) const {
    constexpr double kSameTime = 1e-6;
    MissionRequest timed = on_ways_of(plan, mission);
    timed.objective.deadline_s = duration_s * (1 + kSameTime);
    PlanOptions alone = with_limit_shares(options_.plan, sure.limit_shares);
    alone.baselines = alone.path_bound = false;
    const Plan driven = plan_mission(timed, careful, alone);
    if (!is_driven(driven)) return std::nullopt;
    return kept_share(driven, timed, world.robot, *confidence_);
  }

  /// The classic profiles compared with one point of the front.
  struct Beside {
    std::size_t point{};
    std::vector<BaselineTotal> baselines{};
  };

  /// Indices of so many of the front's points, evenly spaced, including the most economical one.
  static std::vector<std::size_t> chosen(std::size_t points, std::size_t count) {
    std::vector<std::size_t> indices;
    for (std::size_t i = std::min(points, count); i-- > 0;)
      indices.push_back(points - 1 - i * points / std::min(points, count));
    return indices;
  }

  static std::vector<BaselineTotal> baselines_at(const FrontPoint& point, const Plan& plan) {
    const std::vector<FrontStretch> stretches = planned_stretches(plan);
    const FrontPoint rest = rest_of(plan);
    std::vector<TimedStretch> timed;
    for (std::size_t k = 0; k < stretches.size(); ++k)
      timed.push_back({&stretches[k].request, point.stretch_s[k]});
    std::vector<BaselineTotal> totals;
    std::vector<ComparedProfile> compared = [&] {
      const StepScope one_step(nullptr);
      return compare_baselines(timed);
    }();
    finish_steps();
    for (ComparedProfile& profile : compared) {
      totals.push_back(std::move(profile.total));
      add_rest(totals.back(), rest.duration_s, rest.energy_J, rest.motion_energy_J);
    }
    return totals;
  }

  void show(const Front& front, const std::optional<SureFront>& sure, const std::vector<Beside>& beside,
            const report::MissionExtras& extras, OutputDirectory& out) const {
    nlohmann::json result = {{"schema", "joulepath/front/1"},
                             {"mission", extras.title},
                             {"points", points_json(front.points, options_.plan.accuracy)},
                             {"baselines", nlohmann::json::array()}};
    for (const auto& [k, baselines] : beside)
      for (const BaselineTotal& total : baselines) result["baselines"].push_back(baseline_json(total));
    if (sure) result["confidence"] = sure_json(*sure);
    if (writes_analysis(options_))
      write_analysis(out, kResult, result, report::front_report_html(result, extras));
    if (prints_analysis_table(options_, result)) {
      print_points(front.points);
      if (front.points.size() == 1) std::cout << front.summary.message << '\n';
      if (sure) {
        std::cout << "\nwith the margins of the fastest drive that keeps its promises with "
                  << figure(100 * *confidence_, 4) << " %:\n";
        print_points(sure->points);
        for (const auto& [k, account] : sure->judged)
          std::cout << "in " << figure(sure->points[k].duration_s, 6) << " s, "
                    << figure(100 * account.kept, 4) << " % of drawn robots keep all promises (at least "
                    << figure(100 * account.kept_at_least, 4) << " %)\n";
      }
      print_baselines(front, beside);
      print_analysis_place(options_);
    }
  }

  nlohmann::json sure_json(const SureFront& sure) const {
    nlohmann::json json{{"asked", *confidence_},
                        {"limit_shares", sure.limit_shares},
                        {"reserve_margin_fraction", sure.reserve_margin},
                        {"points", points_json(sure.points, options_.plan.accuracy)}};
    for (const auto& [k, account] : sure.judged) {
      nlohmann::json& point = json["points"][k];
      point["kept"] = account.kept, point["kept_at_least"] = account.kept_at_least;
    }
    return json;
  }

  void print_points(const std::vector<FrontPoint>& points) const {
    const bool several = have_several_ways(points);
    std::vector<std::string> header{"duration s", "energy J", "without standby J", "price of a second W",
                                    "on these paths"};
    if (several) header.push_back("paths of");
    Table table(header);
    for (const FrontPoint& point : points) {
      std::vector<std::string> row{
          figure(point.duration_s, 6), figure(point.energy_J, 6), figure(point.motion_energy_J, 6),
          std::isfinite(point.price_of_time_W) ? figure(point.price_of_time_W, 4) : "-",
          solve_status_name(point.status(options_.plan.accuracy))};
      if (several) row.push_back(point.ways);
      table.row(row);
    }
    table.print(std::cout);
  }

  static void print_baselines(const Front& front, const std::vector<Beside>& beside) {
    for (const auto& [k, baselines] : beside) {
      std::cout << "\nat " << figure(front.points[k].duration_s, 5) << " s, least energy "
                << figure(front.points[k].energy_J, 6) << " J:\n";
      Table table(baseline_header());
      for (const BaselineTotal& total : baselines) table.row(baseline_cells(total));
      table.print(std::cout);
    }
  }

  static constexpr const char* kResult = "front.json";
  static constexpr std::size_t kJudged = 3;  ///< points of a sure front, the cheapest among them
  std::optional<double> confidence_{};
  AnalysisOptions options_{};
  std::size_t points_{30};
  std::size_t baseline_points_{3};
};

}  // namespace

std::unique_ptr<Command> make_front_command() { return std::make_unique<FrontCommand>(); }

}  // namespace joulepath
