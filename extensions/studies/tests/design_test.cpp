#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "extensions/studies/sweep/design_search.hpp"
#include "extensions/studies/sweep/design_table.hpp"
#include "extensions/studies/sweep/sweep_analysis.hpp"
#include "model/number_text.hpp"

namespace joulepath {
namespace {

TEST(DesignTable, AGridHoldsEveryCombinationOnce) {
  const DesignTable table =
      DesignTable::grid({{.name = "a", .levels = {"x", "y"}},
                         {.name = "b", .from = 1, .to = 100, .count = 3, .logarithmic = true},
                         {.name = "c", .from = 0, .to = 1, .count = 5}});
  ASSERT_EQ(table.size(), 30u);
  std::set<std::vector<std::string>> designs;
  for (std::size_t k = 0; k < table.size(); ++k) designs.insert(table.at(k));
  EXPECT_EQ(designs.size(), 30u);
  EXPECT_TRUE(designs.contains({"y", "10", "0.25"}));
}

TEST(DesignTable, LevelsOfADecimalRangeHaveNoRoundingErrors) {
  for (const auto& [from, step, count] :
       {std::tuple{1, 1, 10}, {5, 4, 26}, {-10, 2, 11}, {-3, 3, 4}, {8, 1, 13}, {60, 2, 21}}) {
    const DesignTable table = DesignTable::grid({{.name = "a",
                                                  .from = from / 10.0,
                                                  .to = (from + (count - 1) * step) / 10.0,
                                                  .count = std::size_t(count)}});
    for (int k = 0; k < count; ++k)
      EXPECT_EQ(table.at(std::size_t(k)).front(), number_text((from + k * step) / 10.0));
  }
  const DesignTable ratios =
      DesignTable::grid({{.name = "a", .from = 1e-3, .to = 1e3, .count = 7, .logarithmic = true}});
  const char* powers[] = {"0.001", "0.01", "0.1", "1", "10", "100", "1000"};
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(ratios.at(k).front(), powers[k]);
  const DesignTable thirds = DesignTable::grid({{.name = "a", .from = 0, .to = 1, .count = 4}});
  EXPECT_EQ(thirds.at(1).front(), number_text(1.0 / 3)) << "only rounding errors are removed";
}

TEST(DesignTable, AHypercubeHasOneDesignInEachPartOfEachRange) {
  const std::vector<SweepParameter> parameters{{.name = "a", .from = -2, .to = 3},
                                               {.name = "b", .from = 1, .to = 1000, .logarithmic = true},
                                               {.name = "c", .levels = {"p", "q", "r"}}};
  const DesignTable table = DesignTable::latin_hypercube(parameters, 60, 7);
  std::set<int> parts[2];
  std::map<std::string, int> words;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const auto design = table.at(k);
    for (int p = 0; p < 2; ++p)
      parts[p].insert(static_cast<int>(60 * parameters[static_cast<std::size_t>(p)].fraction_of(
                                                std::stod(design[static_cast<std::size_t>(p)]))));
    ++words[design[2]];
  }
  EXPECT_EQ(parts[0].size(), 60u);
  EXPECT_EQ(parts[1].size(), 60u);
  for (const auto& [word, count] : words) EXPECT_EQ(count, 20) << word;
  EXPECT_EQ(DesignTable::latin_hypercube(parameters, 60, 7).at(41), table.at(41));
  EXPECT_NE(DesignTable::latin_hypercube(parameters, 60, 8).at(41), table.at(41));
}

/// y = 2 a + 3 b + a b on {-1, 1}²: variances 4, 9 and 1 of 14.
TEST(SweepEffects, SharesAreThoseOfTheFormula) {
  std::vector<std::string> a, b;
  std::vector<double> y;
  for (const double u : {-1.0, 1.0})
    for (const double v : {-1.0, 1.0}) {
      a.push_back(number_text(u));
      b.push_back(number_text(v));
      y.push_back(1000.0 + 2 * u + 3 * v + u * v);
    }
  const SweepEffects effects = sweep_effects({levels_of("a", a), levels_of("b", b)}, y);
  EXPECT_NEAR(effects.main[0].share_of_variance, 4.0 / 14, 1e-9);
  EXPECT_NEAR(effects.main[1].share_of_variance, 9.0 / 14, 1e-9);
  ASSERT_EQ(effects.interactions.size(), 1u);
  EXPECT_NEAR(effects.interactions[0].share_of_variance, 1.0 / 14, 1e-9);
  EXPECT_NEAR(effects.unexplained, 0.0, 1e-9);
  EXPECT_NEAR(effects.main[0].levels[1].mean - effects.main[0].levels[0].mean, 4.0, 1e-9);
}

TEST(SweepEffects, AHoleInTheTableGivesNoEffectToAParameterWithoutOne) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> level(0, 3);
  std::vector<std::string> a, b;
  std::vector<double> y;
  for (int k = 0; k < 400; ++k) {
    const int u = level(random), v = level(random);
    if (u + v > 3) continue;  // the designs without a plan: levels are correlated then
    a.push_back(std::to_string(u));
    b.push_back(std::to_string(v));
    y.push_back(5.0 * u);
  }
  const SweepEffects effects = sweep_effects({levels_of("a", a), levels_of("b", b)}, y);
  EXPECT_GT(effects.main[0].share_of_variance, 0.5);
  EXPECT_NEAR(effects.main[1].share_of_variance, 0.0, 1e-9);
}

/// Each value of a Latin hypercube is one design's own: with a level for each, any parameter explains all.
TEST(SweepEffects, AreFoundInALatinHypercubeOfFewDesigns) {
  const std::vector<int> shuffled{4, 7, 1, 6, 0, 5, 2, 3};
  std::vector<std::string> a, b;
  std::vector<double> y;
  for (int k = 0; k < 8; ++k) {
    const int other = shuffled[static_cast<std::size_t>(k)];
    a.push_back(std::to_string(0.5 * k));
    b.push_back(std::to_string(10.0 + other));
    y.push_back(10.0 * k + other);
  }
  const SweepEffects effects = sweep_effects(level_columns({"a", "b"}, {a, b}), y);
  EXPECT_GT(effects.main[0].share_of_variance, 0.5);
  EXPECT_LT(effects.main[1].share_of_variance, 0.1);
  EXPECT_EQ(level_columns({"a"}, {a}).front().labels.size(), 8u) << "alone, a parameter keeps its levels";
}

TEST(ParetoFront, IsThatOfAComparisonOfAllPairs) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> value(0, 12);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::vector<double>> rows(60);
    for (auto& row : rows) row = {double(value(random)), double(value(random)), double(value(random))};
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      bool beaten = false;
      for (const auto& other : rows)
        beaten = beaten || (other != rows[i] && other[0] <= rows[i][0] && other[1] <= rows[i][1] &&
                            other[2] <= rows[i][2]);
      if (!beaten) expected.push_back(i);
    }
    EXPECT_EQ(pareto_front(rows), expected);
  }
}

TEST(DesignSearch, FindsTheBestPointOnAConstraint) {
  const auto value = [](const std::vector<double>& x) {
    return DesignValue{x[0] < 0.95, std::pow(x[0] - 0.9, 2) + std::pow(x[1] - 0.2, 2),
                       std::max(0.0, x[0] - 0.6)};
  };
  const DesignSearch found = search_design({0.2, 0.9}, 400, 1e-5, value);
  EXPECT_NEAR(found.best[0], 0.6, 1e-3);
  EXPECT_NEAR(found.best[1], 0.2, 1e-3);
  EXPECT_LE(found.value.excess, 0.0);
  EXPECT_LE(found.evaluations, 400u);
}

}  // namespace
}  // namespace joulepath
