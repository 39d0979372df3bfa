#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/attribution.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/verdict/names.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr int kRaceRuns = 10, kRaceSamples = 60;
constexpr int kCalibration = 0, kLaw = 1, kOtherLaw = 2, kFirstOfTerm = 3, kColumns = 7;

/// Parameters of a drawn gap: of a law, and of an unknown term with four columns of which the first follows
/// the law's signature; or of the small difference of the two, where nothing else tells them apart.
struct Gap {
  double law{};
  double term{};
  double difference{};
  double other_law{};
};

/// Whitened rows of one calibration constant, two laws and one unknown term.
Equations drawn(const Gap& gap) {
  std::mt19937 engine(11);
  std::normal_distribution<double> normal;
  Equations equations;
  equations.columns = {{Column::Kind::nuisance, 0, 0, 0.05, 0.0},
                       {Column::Kind::amplitude, 0, 0, 1.0, 0.0},
                       {Column::Kind::amplitude, 1, 0, 1.0, 0.0}};
  for (int k = 0; k < 4; ++k) equations.columns.push_back({Column::Kind::dictionary, k, 0, 1.0, 0.0});
  for (const char* name : {"viscous_friction", "quadratic_drag"})
    equations.candidates.push_back({.shape = {.name = name}, .amplitude = {"size"}, .step = {0.25}});
  equations.unknowns = {{"wheel speed (current)", {3, 4, 5, 6}}};
  equations.prior_sd = Eigen::VectorXd::Ones(kColumns);
  equations.prior_sd[kCalibration] = 0.05;
  for (int r = 0; r < kRaceRuns; ++r) {
    Eigen::MatrixXd rows(kRaceSamples, kColumns + 1);
    for (int t = 0; t < kRaceSamples; ++t) {
      for (int k = 0; k < kColumns; ++k) rows(t, k) = normal(engine);
      rows(t, kFirstOfTerm) += rows(t, kLaw);
      double curve = 0;
      for (int k = 0; k < 4; ++k) curve += rows(t, kFirstOfTerm + k);
      const double difference = normal(engine);
      if (gap.difference != 0) rows(t, kLaw) = rows(t, kFirstOfTerm) + 1e-3 * difference;
      rows(t, kColumns) = gap.difference * difference + gap.law * rows(t, kLaw) + gap.term * curve +
                          gap.other_law * rows(t, kOtherLaw) + normal(engine);
    }
    equations.runs.push_back({.gram = rows.transpose() * rows});
  }
  return equations;
}

std::vector<Explanation> raced(const Equations& equations) {
  return search_explanations(without_calibration(equations, every(kRaceRuns)), equations, {});
}

TEST(Race, ALawThatIsThereWinsAlone) {
  const Explanation best = raced(drawn({.law = 0.6})).front();
  EXPECT_EQ(best.candidates, std::vector<int>{0});
  EXPECT_TRUE(best.unknowns.empty());
}

TEST(Race, AnUnknownCauseWinsOverALawThatFollowsAPartOfIt) {
  const Explanation best = raced(drawn({.term = 0.5})).front();
  EXPECT_TRUE(best.candidates.empty());
  EXPECT_EQ(best.unknowns, std::vector<int>{0});
}

TEST(Race, ALawKeepsItsNameBesideAnUnknownCause) {
  const Equations equations = drawn({.law = 0.8, .term = 0.4});
  const std::vector<Explanation> explanations = raced(equations);
  EXPECT_EQ(explanations.front().candidates, std::vector<int>{0});
  EXPECT_EQ(explanations.front().unknowns, std::vector<int>{0});
  Inclusion inclusion;
  inclusion.add(equations, explanations);
  EXPECT_GT(inclusion.of("viscous_friction"), 0.95);
  EXPECT_GT(inclusion.of("wheel speed (current)"), 0.95);
  EXPECT_LT(inclusion.of("quadratic_drag"), 0.05);
}

TEST(Race, NoiseAloneNamesNothing) {
  const Explanation best = raced(drawn({})).front();
  EXPECT_TRUE(best.candidates.empty());
  EXPECT_TRUE(best.unknowns.empty());
}

/// A law's form is inexact: what an unknown term adds is small beside the law, although the evidence is not.
TEST(Race, ATermThatRefinesALawIsNoCauseBesideIt) {
  const Explanation best = raced(drawn({.law = 10.0, .term = 0.4})).front();
  EXPECT_EQ(best.candidates, std::vector<int>{0});
  EXPECT_TRUE(best.unknowns.empty());
}

/// {0, 1} is the best set; {2, 3} explains less and holds no small member.
TEST(SmallMembers, DoNotGiveTheBestSetsPlaceToAWorseOne) {
  std::vector<Explanation> sets{{.candidates = {0, 1}, .score = 20, .small = {1}},
                                {.candidates = {2, 3}, .score = 12},
                                {.candidates = {0}, .score = 10},
                                {.candidates = {1}, .score = 5, .small = {1}},
                                {}};
  erase_immaterial(sets);
  EXPECT_EQ(sets.front().candidates, (std::vector<int>{0, 1}));
  EXPECT_EQ(sets.size(), 4u) << "a small effect alone is no answer";
}

TEST(SmallMembers, AloneAreNoAnswer) {
  std::vector<Explanation> sets{
      {.candidates = {1}, .score = 9, .small = {1}}, {.candidates = {0, 1}, .score = 8, .small = {1}}, {}};
  erase_immaterial(sets);
  ASSERT_EQ(sets.size(), 1u);
  EXPECT_TRUE(sets.front().candidates.empty());
}

TEST(SmallMembers, AreNotNamedBesideALargeOne) {
  const Dataset dataset{.robot = testing::nomad()};
  const RunsByUse runs;
  Identification id{.equations = drawn({.law = 0.6, .other_law = 0.6})};
  id.problem = without_calibration(id.equations, every(kRaceRuns));
  for (const Candidate& candidate : id.equations.candidates) id.state.effects.push_back({candidate, {0.6}});
  const auto names = [&](double least_of_other) {
    id.options.least_amplitude = {0.1, least_of_other};
    id.explanations = search_explanations(id.problem, id.equations, id.options);
    erase_immaterial(id.explanations);
    return choose_names({.dataset = dataset, .runs = runs, .id = id}).named;
  };
  EXPECT_EQ(names(0.1).size(), 2u);
  ASSERT_EQ(names(10.0).size(), 1u);
  EXPECT_EQ(names(10.0).front().candidate.label(), "viscous_friction");
}

/// Whether a law of this size (over the floor) is beyond doubt, were it told by this many runs.
bool is_beyond_doubt(double strength, std::size_t runs, const std::string& law, double size = 0.75) {
  Equations equations = drawn({.law = strength});
  equations.candidates.front().shape.name = law;
  const double least = strength / size;
  return search_explanations(without_calibration(equations, every(kRaceRuns)), equations,
                             search_options(1.0, runs, {least, least}))
      .front()
      .small.empty();
}

/// 600 readings of unit noise give a law of strength s about 300 s^2 - 9 log units, 10 to 18 and 66 with this
/// noise.
TEST(SmallMembers, OfFewRunsNeedAFirmLawAndTwiceTheEvidence) {
  EXPECT_TRUE(is_beyond_doubt(0.5, kRunsForSmallEffects, "viscous_friction"));
  EXPECT_FALSE(is_beyond_doubt(0.25, 6, "viscous_friction"));
  EXPECT_TRUE(is_beyond_doubt(1.0, 6, "viscous_friction"));
  EXPECT_FALSE(is_beyond_doubt(0.5, 6, "turning_scrub"));
  EXPECT_FALSE(is_beyond_doubt(0.5, kRunsForSmallEffects, "viscous_friction", 0.1)) << "the model's own error";
}

/// A law of five hundred times its size that a term takes back fits the gap, and explains nothing.
TEST(Race, ALawAndATermThatCancelEachOtherAreNoExplanation) {
  Equations equations = drawn({.difference = 0.5});
  equations.prior_sd.setConstant(1e4);
  for (const Explanation& e : raced(equations))
    EXPECT_FALSE(!e.candidates.empty() && e.candidates.front() == 0 && !e.unknowns.empty() && e.score > 0);
}

/// Two laws that share the evidence: neither is sure, and that one of them is there is.
TEST(Inclusion, OfSomethingCountsWhatMatters) {
  Equations equations = drawn({.law = 0.6});
  for (RunEquations& run : equations.runs) {
    run.gram.row(kOtherLaw) = run.gram.row(kLaw);
    run.gram.col(kOtherLaw) = run.gram.col(kLaw);
  }
  const auto something = [&](double least_amplitude) {
    Inclusion inclusion;
    inclusion.add(equations, search_explanations(without_calibration(equations, every(kRaceRuns)), equations,
                                                 {.least_amplitude = {least_amplitude, least_amplitude}}));
    EXPECT_LT(inclusion.of("viscous_friction"), 0.7);
    return inclusion.of_something();
  };
  EXPECT_GT(something(0.1), 0.99);
  EXPECT_LT(something(100.0), 0.1) << "below the materiality floor";
}

TEST(Inclusion, IsAProbabilityWhateverTheGroup) {
  Equations equations = drawn({.law = 0.6});
  for (RunEquations& run : equations.runs) {  // the second law's signature equals the first one's
    run.gram.row(kOtherLaw) = run.gram.row(kLaw);
    run.gram.col(kOtherLaw) = run.gram.col(kLaw);
  }
  Inclusion inclusion;
  inclusion.add(equations, raced(equations));
  EXPECT_NEAR(inclusion.of("viscous_friction"), inclusion.of("quadratic_drag"), 1e-6);
  EXPECT_GT(inclusion.of_any({"viscous_friction", "quadratic_drag"}), 0.99);
  EXPECT_LE(inclusion.of_any({"viscous_friction", "quadratic_drag"}), 1.0);
}

TEST(RunDispersion, OfFewRunsUnderAWideFitIsThatOfTheNoise) {
  std::mt19937 engine(21);
  std::normal_distribution<double> normal;
  constexpr int kFew = 6, kWide = 24;
  constexpr double kScatter = 2.0;
  double sum = 0;
  constexpr int kDraws = 40;
  for (int draw = 0; draw < kDraws; ++draw) {
    Equations equations;
    equations.prior_sd = Eigen::VectorXd::Constant(kWide, 100.0);
    std::vector<int> fitted;
    for (int k = 0; k < kWide; ++k) equations.columns.push_back({Column::Kind::amplitude, k, 0, 100.0, 0.0});
    for (int k = 0; k < kWide; ++k) fitted.push_back(k);
    for (int r = 0; r < kFew; ++r) {
      Eigen::MatrixXd rows(kWide / 3, kWide + 1);  // 48 rows for 24 columns
      for (double& x : rows.reshaped()) x = normal(engine);
      rows.col(kWide) *= std::sqrt(kScatter);
      equations.runs.push_back({.gram = rows.transpose() * rows});
    }
    sum += run_dispersion(equations, fitted);
  }
  EXPECT_NEAR(sum / kDraws, kScatter, 0.2);
}

/// Fifteen straight runs of five payloads and five spins that share one of these payloads.
Dataset straight_runs_and_five_spins() {
  Dataset dataset{.robot = testing::nomad()};
  for (int k = 0; k < 20; ++k) {
    const bool spin = k >= 15;
    const auto law = testing::swinging(spin ? 0.0 : 0.4, 0.0, 1.0, spin ? 0.8 : 0.0);
    dataset.runs.push_back(testing::synthetic_run(dataset.robot, "run_" + std::to_string(k), 8,
                                                  spin ? 2.0 : 2.0 * (k % 5), law, {0.01, 0.01, 0.01},
                                                  static_cast<unsigned>(k)));
  }
  return dataset;
}

/// Places in the dictionary of a family and channel.
std::vector<int> entries_of(const DictionaryLayout& layout, const std::string& family,
                            const std::string& channel) {
  std::vector<int> found;
  const std::vector<DictionaryEntry> entries = dictionary_entries(layout);
  for (std::size_t k = 0; k < entries.size(); ++k)
    if (entries[k].family == family && entries[k].channel == channel) found.push_back(static_cast<int>(k));
  return found;
}

/// Square of the rows that the half track moves, all runs.
double excitation_of_half_track(const Dataset& dataset) {
  Robot robot = dataset.robot;
  robot.uncertainty = {{"half_track_m", 0.01}};
  const std::vector<Nuisance> nuisances = calibration_nuisances(robot);
  const ModelState nominal{.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)};
  const Equations equations =
      build_equations(sort_runs(dataset).signals, robot, nuisances, nominal, {}, {.dictionary = false});
  double square = 0;
  for (std::size_t k = 0; k < nuisances.size(); ++k)
    if (nuisances[k].key == "half_track_m")
      for (const RunEquations& run : equations.runs)
        square += run.gram(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k));
  return square;
}

/// Columns of each unknown term of these runs, with some effects taken out of the catalog.
std::map<std::string, std::size_t> columns_of_unknowns(const Dataset& dataset,
                                                       const std::set<std::string>& without) {
  const std::vector<Nuisance> nuisances = calibration_nuisances(dataset.robot);
  const ModelState nominal{.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)};
  const Equations equations = build_equations(sort_runs(dataset).signals, dataset.robot, nuisances, nominal,
                                              {}, {.without = without});
  std::map<std::string, std::size_t> columns;
  for (const UnknownTerm& term : equations.unknowns) columns[term.label] = term.columns.size();
  return columns;
}

/// What the catalog has a law for is not unknown: a term with the law's own rows would stand for it.
TEST(UnknownTerm, LeavesOutWhatALawOfTheCatalogIs) {
  const Dataset dataset = straight_runs_and_five_spins();
  auto all = columns_of_unknowns(dataset, {}),
       fewer = columns_of_unknowns(dataset, {"current_sensor_offset", "current_sensor_gain",
                                             "gear_efficiency", "driver_voltage_drop"});
  EXPECT_FALSE(all.contains("constant (current reading)") || all.contains("motor torque (current)"));
  EXPECT_EQ(all["current (current reading)"], 1u) << "one sensor against the other is no law";
  EXPECT_EQ(fewer["constant (current reading)"], 2u);
  EXPECT_EQ(fewer["motor torque (current)"], 1u);
  EXPECT_EQ(fewer["current (current reading)"], 2u);
  EXPECT_EQ(fewer["current (voltage)"], all["current (voltage)"] + 1);
}

TEST(StraightRuns, DoNotShowTheHalfTrackHoweverNoisyTheWheels) {
  Dataset dataset = straight_runs_and_five_spins();
  for (auto& run : dataset.runs) run.log.gyro_yaw_rate_rad_s.assign(run.log.size(), 0.0);
  EXPECT_GT(excitation_of_half_track(dataset), 1.0);
  dataset.runs.resize(15);
  EXPECT_EQ(excitation_of_half_track(dataset), 0.0);
}

TEST(Materiality, OfATermIsThatOfTheLawThatItDraws) {
  const Dataset dataset = straight_runs_and_five_spins();
  const std::vector<RunSignals> signals = sort_runs(dataset).signals;
  constexpr double kTorque_Nm = 0.05;
  Robot harder = dataset.robot;
  for (Side side : kSides) harder.motor[side].friction_torque_Nm += kTorque_Nm;
  const Impact law = impact_between(signals, {.robot = harder}, {.robot = dataset.robot});
  // Hats over the wheel speed sum to 1; the entry of the left less the right wheel stays 0.
  const std::vector<int> hats = entries_of(lay_out(signals, dataset.robot), "wheel speed", "current");
  Eigen::VectorXd torque_Nm = Eigen::VectorXd::Constant(std::ssize(hats), kTorque_Nm);
  torque_Nm[1] = 0;
  const Impact term = impact_of_term(signals, {.robot = dataset.robot}, hats, torque_Nm);
  ASSERT_GT(law.motor_power, 0.005);
  EXPECT_NEAR(term.motor_power, law.motor_power, 0.1 * law.motor_power);
  EXPECT_EQ(term.heading_rad, 0.0);
}

TEST(Materiality, OfATermOfTheMotionIsWhereTheRunsEnd) {
  const Dataset dataset = straight_runs_and_five_spins();
  const std::vector<RunSignals> signals = sort_runs(dataset).signals;
  const std::vector<int> speed = entries_of(lay_out(signals, dataset.robot), "speed", "motion");
  Eigen::VectorXd strength = Eigen::VectorXd::Zero(std::ssize(speed));
  strength[0] = 0.01;
  const Impact impact = impact_of_term(signals, {.robot = dataset.robot}, speed, strength);
  EXPECT_NEAR(impact.position, 0.01, 0.001);
  EXPECT_EQ(impact.motor_power, 0.0);
}

TEST(Folds, SpreadARareManoeuvreBeforeThePayload) {
  const Dataset dataset = straight_runs_and_five_spins();
  const RunsByUse runs = sort_runs(dataset);
  ASSERT_EQ(fold_count(runs), 5u);
  EXPECT_EQ(runs.diagnosis.runs.size(), 20u);
  std::set<std::size_t> folds_of_spins;
  for (std::size_t r = 15; r < 20; ++r) folds_of_spins.insert(runs.fold_of[r]);
  EXPECT_EQ(folds_of_spins.size(), 5u);
  for (std::size_t fold = 0; fold < 5; ++fold) EXPECT_EQ(fitted_runs(runs, fold).size(), 16u);
}

TEST(Folds, RunsForValidationNeitherChooseNorFit) {
  Dataset dataset = straight_runs_and_five_spins();
  for (std::size_t r : {3u, 16u}) dataset.runs[r].use = RunUse::validation;
  const RunsByUse runs = sort_runs(dataset);
  EXPECT_EQ(fold_count(runs), 0u);
  EXPECT_EQ(runs.validation.runs, (std::vector<std::size_t>{3, 16}));
  EXPECT_EQ(runs.diagnosis.runs.size(), 18u);
}

}  // namespace
}  // namespace joulepath
