#include "scenarios/result_files/decision_cost.hpp"

#include <gtest/gtest.h>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

TEST(DecisionCost, TheRightModelLosesNothing) {
  const DecisionCost cost = decision_cost(testing::nomad(), testing::nomad());
  EXPECT_EQ(cost.missions, 4u);
  EXPECT_EQ(cost.joules_lost_percent, 0.0);
}

TEST(DecisionCost, AWrongModelNeverPlansBetter) {
  Robot patient = testing::nomad();
  patient.power.standby_W = 2.0;
  patient.motor.left.resistance_ohm = patient.motor.right.resistance_ohm = 2.0;
  Robot real = patient;
  real.effects = {{.name = "quadratic_drag", .parameters = {{"coefficient_N_s2_m2", 10.0}}}};
  const DecisionCost cost = decision_cost(patient, real);
  EXPECT_EQ(cost.missions, 4u);
  EXPECT_GT(cost.joules_lost_percent, 0.5);  // with strong drag the best drive is slower
  EXPECT_LT(cost.joules_lost_percent, 50.0);
}

}  // namespace
}  // namespace joulepath
