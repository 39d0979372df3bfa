// Shares of the gap by place, against sums over booked joules.
#include "diagnosis/where/gap_ledger.hpp"

#include <gtest/gtest.h>

namespace joulepath {
namespace {

const WhereCell& cell(const std::vector<WhereCell>& cells, const std::string& value) {
  for (const WhereCell& some : cells)
    if (some.value == value) return some;
  throw std::runtime_error("no cell " + value);
}

/// Three runs. Per run, cruising has a gap of 10 J of which 4 J are noise, braking 30 and 8 J, standing noise
/// only.
GapLedger booked_runs() {
  GapLedger ledger(3);
  for (std::size_t run = 0; run < 3; ++run) {
    ledger.book("phase", "cruise", run, {.gap_J = 10, .noise_J = 4, .signed_J = -5, .measured_J = 100});
    for (int half = 0; half < 2; ++half)
      ledger.book("phase", "brake", run, {.gap_J = 15, .noise_J = 4, .signed_J = 6, .measured_J = 20});
    ledger.book("phase", "standstill", run, {.gap_J = 1, .noise_J = 5});
    ledger.book("wheel", "left", run, {.gap_J = 7});
  }
  return ledger;
}

TEST(GapLedger, SharesAreOfTheGapBeyondNoise) {
  const std::vector<WhereCell> cells = booked_runs().cells({"phase"}, 100);
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_NEAR(cell(cells, "brake").share_of_gap, 22.0 / 28, 1e-12);
  EXPECT_NEAR(cell(cells, "cruise").share_of_gap, 6.0 / 28, 1e-12);
  EXPECT_EQ(cell(cells, "standstill").share_of_gap, 0.0) << "less than its noise";
  EXPECT_EQ(cells[0].value, "brake") << "the greatest first";
  EXPECT_NEAR(cell(cells, "brake").energy_J, 66, 1e-12);
  EXPECT_NEAR(*cell(cells, "cruise").bias_percent, -5, 1e-12);
  EXPECT_NEAR(*cell(cells, "brake").bias_percent, 30, 1e-12);
  EXPECT_FALSE(cell(cells, "standstill").bias_percent) << "nothing measured there";
}

TEST(GapLedger, GivesTheAxesAskedForInTheirOrder) {
  const std::vector<WhereCell> cells = booked_runs().cells({"wheel", "floor", "phase"}, 10);
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0].axis, "wheel");
  EXPECT_EQ(cells[0].share_of_gap, 1.0);
  EXPECT_EQ(cells[1].axis, "phase");
}

/// Runs that are alike leave no doubt; if one run has all the gap of a cell, a sample of runs may lack it.
TEST(GapLedger, IntervalsShowHowRunsDiffer) {
  const WhereCell alike = cell(booked_runs().cells({"phase"}, 200), "brake");
  EXPECT_NEAR(alike.interval_95.first, alike.share_of_gap, 1e-12);
  EXPECT_NEAR(alike.interval_95.second, alike.share_of_gap, 1e-12);
  GapLedger ledger(3);
  for (std::size_t run = 0; run < 3; ++run) ledger.book("phase", "cruise", run, {.gap_J = 10});
  ledger.book("phase", "brake", 1, {.gap_J = 30});
  const WhereCell odd = cell(ledger.cells({"phase"}, 200), "brake");
  EXPECT_NEAR(odd.share_of_gap, 0.5, 1e-12);
  EXPECT_EQ(odd.interval_95.first, 0.0);
  EXPECT_GT(odd.interval_95.second, 0.6);
}

}  // namespace
}  // namespace joulepath
