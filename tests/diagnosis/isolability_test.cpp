// What the runs' design shows and tells apart: physics first, then against diagnoses of an independent plant.
#include "diagnosis/evidence/isolability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "diagnosis/evidence/power.hpp"
#include "diagnosis/values/constant_payload.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/effects/catalog.hpp"
#include "tests/support/blind_day.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr testing::LogNoise kUsualNoise{.speed_rad_s = 0.02, .current_A = 0.02, .voltage_V = 0.02};

/// A dataset of runs with currents and voltages, one after the other over the day.
class Day {
 public:
  Day& drive(double payload_kg, const testing::MotionLaw& law) {
    const auto number = static_cast<unsigned>(dataset_.runs.size());
    Run run = testing::synthetic_run(dataset_.robot, "run " + std::to_string(number), 15, payload_kg, law,
                                     kUsualNoise, number + 1);
    run.start_time_s = 30.0 * number;
    dataset_.runs.push_back(run);
    return *this;
  }

  Isolability design() const { return isolability(dataset_, sort_runs(dataset_)); }
  const Dataset& dataset() const { return dataset_; }

 private:
  Dataset dataset_{.robot = testing::nomad()};
};

/// Lanes in both directions with each payload.
Day lanes(const std::vector<double>& payloads_kg) {
  Day day;
  for (double payload_kg : payloads_kg)
    for (double mean_m_s : {0.3, 0.6, -0.4}) day.drive(payload_kg, testing::swinging(mean_m_s, 0.2, 0.8));
  return day;
}

bool is_seen(const Isolability& design, const std::string& effect) {
  const auto found = std::ranges::find(design.effects, effect, &Isolability::Effect::effect);
  EXPECT_NE(found, design.effects.end()) << effect;
  return found->probability_seen >= 0.9;
}

Isolability::Pair pair_of(const Isolability& design, const std::string& a, const std::string& b) {
  for (const Isolability::Pair& pair : design.pairs)
    if (std::set{pair.effect, pair.other} == std::set{a, b}) return pair;
  ADD_FAILURE() << a << " and " << b << " are no pair";
  return {};
}

double told_apart(const Isolability& design, const std::string& a, const std::string& b) {
  return pair_of(design, a, b).probability_told_apart;
}

bool share_a_group(const Isolability& design, const std::string& a, const std::string& b) {
  return std::ranges::any_of(inseparable_groups(design), [&](const std::vector<std::string>& group) {
    return std::ranges::count(group, a) > 0 && std::ranges::count(group, b) > 0;
  });
}

TEST(Isolability, StraightRunsShowNothingOfTurning) {
  const Isolability straight = lanes({0, 6, 12}).design();
  for (const char* effect : {"turning_scrub", "yaw_inertia_error", "caster_swivel", "track_width_error"})
    EXPECT_FALSE(is_seen(straight, effect)) << effect;
  EXPECT_TRUE(is_seen(straight, "coulomb_friction"));
  EXPECT_TRUE(is_seen(straight, "dragging_wheel (left)"));
}

TEST(Isolability, ATurningRunShowsScrubAndTellsItFromOtherFriction) {
  Day day = lanes({0, 6, 12});
  for (double turn_rad_s : {0.8, -0.8})
    day.drive(0, [=](double) { return BodyMotion<double>{.yaw_rate_rad_s = turn_rad_s}; })
        .drive(6, testing::swinging(0.4, 0.1, 0.5, turn_rad_s));
  const Isolability turning = day.design();
  EXPECT_TRUE(is_seen(turning, "turning_scrub"));
  for (const char* other : {"coulomb_friction", "rolling_resistance", "viscous_friction"})
    EXPECT_GT(told_apart(turning, "turning_scrub", other), 0.9) << other;
}

/// An inexact form may hide a part of the difference: 12 kg are half of this robot's mass.
TEST(Isolability, OnePayloadMakesLoadDependentAndConstantFrictionOneGroup) {
  const Isolability one = lanes({6, 6, 6}).design(), three = lanes({0, 6, 12}).design();
  EXPECT_LT(told_apart(one, "rolling_resistance", "coulomb_friction"), 0.1);
  EXPECT_LT(pair_of(one, "rolling_resistance", "coulomb_friction").likelihood_ratio, 0.1)
      << "data of the one are data of the other";
  EXPECT_TRUE(share_a_group(one, "rolling_resistance", "coulomb_friction"));
  EXPECT_GT(told_apart(three, "rolling_resistance", "coulomb_friction"), 0.7);
}

/// The runs have currents and voltages alone.
TEST(Isolability, AnEffectOfAMissingChannelOrMotionIsNotSeen) {
  const Isolability straight = lanes({0, 6, 12}).design();
  for (const char* effect : {"wheel_radius_error", "supply_sag", "standby_power_error"})
    EXPECT_FALSE(is_seen(straight, effect)) << effect;
}

/// What a diagnosis found is seen, whatever its usual size: no list and no sentence says otherwise.
TEST(Isolability, WhatWasFoundIsNotListedAsUnseen) {
  const std::string found = "turning_scrub", other = "caster_swivel";
  const Dataset day = lanes({0, 6, 12}).dataset();
  const RunsByUse runs = sort_runs(day);
  const Isolability design = isolability(runs.signals, day.robot, noise_of_runs(runs.signals, day.robot, {}),
                                         {found, other}, {}, {found});
  const std::vector<std::string> unseen = unseen_effects(design);
  EXPECT_EQ(std::ranges::count(unseen, found), 0);
  EXPECT_EQ(std::ranges::count(unseen, other), 1);
  for (const std::string& note : isolability_notes(design))
    EXPECT_EQ(note.find(found), std::string::npos) << note;
  EXPECT_TRUE(std::ranges::find(design.effects, found, &Isolability::Effect::effect)->is_found);
}

/// An effect is seen at its usual size where this is no less than the one from which on it is seen.
TEST(Isolability, SeenFromIsTheSizeOfNineInTen) {
  Day day = lanes({0, 12});
  for (double turn_rad_s : {0.8, -0.8}) day.drive(6, testing::swinging(0.4, 0.1, 0.5, turn_rad_s));
  std::size_t compared = 0;
  for (const Isolability::Effect& effect : day.design().effects) {
    const EffectDescription* described = find_effect(effect.effect);  // none of a side
    if (!described || described->in_robot_file || described->strength().role != ParameterRole::strength ||
        described->find(ParameterRole::direction))
      continue;
    const double usual = typical_size(described->strength(), testing::nomad());
    if (effect.probability_seen >= 0.9) {
      ASSERT_TRUE(effect.seen_from) << effect.effect;
      EXPECT_LE(effect.seen_from->value, usual) << effect.effect;
      ++compared;
    } else if (effect.seen_from) {
      EXPECT_GT(effect.seen_from->value, usual) << effect.effect;
    }
  }
  EXPECT_GT(compared, 5U);
}

TEST(Isolability, IsTheSameTwiceAndEveryPairOnce) {
  const Isolability design = lanes({0, 6}).design(), again = lanes({0, 6}).design();
  const std::size_t seen = design.effects.size() - unseen_effects(design).size();
  EXPECT_EQ(design.pairs.size(), seen * (seen - 1) / 2);
  for (std::size_t k = 0; k < design.pairs.size(); ++k)
    EXPECT_EQ(design.pairs[k].likelihood_ratio, again.pairs[k].likelihood_ratio);
}

TEST(Isolability, AThresholdOfItsExpectationIsPassedInHalfOfCases) {
  EXPECT_NEAR(probability_told_apart(kStandInLoss), 0.5, 1e-12);
  EXPECT_EQ(probability_told_apart(0.0), 0.0);
  EXPECT_GT(probability_told_apart(25.0), 0.95);
}

/// Each effect is in each group at most once, and a group has no larger one around it.
TEST(Isolability, GroupsAreMaximal) {
  const Isolability made{
      .effects = {{"a", 1}, {"b", 1}, {"c", 1}, {"d", 1}},
      .pairs = {
          {"a", "b", 1, 0.1}, {"a", "c", 1, 0.1}, {"b", "c", 1, 0.1}, {"c", "d", 1, 0.1}, {"a", "d", 50, 1}}};
  EXPECT_EQ(inseparable_groups(made), (std::vector<std::vector<std::string>>{{"a", "b", "c"}, {"c", "d"}}));
}

/// A poor dataset shows many effects that it does not tell apart: without a pivot this takes 2^30 steps.
TEST(Isolability, ThirtyEffectsThatAreNotToldApartAreOneGroup) {
  Isolability made;
  for (int k = 0; k < 30; ++k) {
    made.effects.push_back({"effect " + std::to_string(100 + k), 1});
    for (int j = 0; j < k; ++j)
      made.pairs.push_back(
          {made.effects[static_cast<std::size_t>(j)].effect, made.effects.back().effect, 1, 0.1});
  }
  const auto groups = inseparable_groups(made);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups.front().size(), 30U);
}

class AgainstDiagnoses : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  }
};

/// A run's payload; each is constant.
double payload_of_kg(const Run& run) {
  return run.log.payload_kg.empty() ? constant_payload_kg(run) : run.log.payload_kg.front();
}

/// The payload that most runs have.
double usual_payload_kg(const Dataset& day) {
  std::map<double, int> count;
  for (const Run& run : day.runs) ++count[payload_of_kg(run)];
  return std::ranges::max_element(count, {}, [](const auto& entry) { return entry.second; })->first;
}

std::set<std::string> group_of(const Diagnosis& diagnosis, const std::string& effect) {
  std::set<std::string> group;
  for (const Cause& cause : diagnosis.causes) {
    std::set<std::string> own(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
    own.insert(cause.effect.name);
    if (own.contains(effect)) group = own;
  }
  return group;
}

TEST_F(AgainstDiagnoses, WhatIsNotToldApartIsAGroupAndWhatIsHasOneName) {
  const Dataset day = testing::blind_day("--effect rolling_resistance --size 0.012 --protocol 24 --seed 31");
  const double payload_kg = usual_payload_kg(day);
  Dataset one = day;
  std::erase_if(one.runs, [&](const auto& run) { return payload_of_kg(run) != payload_kg; });
  ASSERT_GE(one.runs.size(), 4U);
  const Diagnosis of_one = diagnose(one, {.bootstrap = 20}), of_all = diagnose(day, {.bootstrap = 20});
  const std::set<std::string> group = group_of(of_one, "rolling_resistance");
  EXPECT_TRUE(group.contains("coulomb_friction"));
  for (const std::string& other : group)
    if (other != "rolling_resistance") {
      EXPECT_LT(told_apart(of_one.isolability, "rolling_resistance", other), 0.9) << other;
    }
  EXPECT_EQ(group_of(of_all, "rolling_resistance"), std::set<std::string>{"rolling_resistance"});
  for (const char* other : {"viscous_friction", "gear_efficiency", "dragging_wheel (left)", "floor_slope"})
    EXPECT_GT(told_apart(of_all.isolability, "rolling_resistance", other), 0.9) << other;
  EXPECT_GT(told_apart(of_all.isolability, "rolling_resistance", "coulomb_friction"),
            told_apart(of_one.isolability, "rolling_resistance", "coulomb_friction") + 0.5);
}

TEST_F(AgainstDiagnoses, AnEffectTakenOutOfTheCatalogIsInNoGroup) {
  const Dataset day = testing::blind_day("--effect none --protocol 12 --seed 5");
  const Isolability whole = diagnose(day, {.bootstrap = 20}).isolability,
                    rest = diagnose(day, {.bootstrap = 20, .without = {"coulomb_friction"}}).isolability;
  const auto lists = [](const Isolability& found) {
    return std::ranges::count(found.effects, "coulomb_friction", &Isolability::Effect::effect) > 0;
  };
  EXPECT_TRUE(lists(whole));
  EXPECT_FALSE(lists(rest));
  EXPECT_EQ(rest.effects.size() + 1, whole.effects.size());
}

/// The statement before a diagnosis and the one within it rest on two estimates of one noise.
TEST_F(AgainstDiagnoses, CheckAndDiagnoseAgree) {
  const Dataset day = testing::blind_day("--effect none --protocol 12 --seed 5");
  const Isolability before = isolability(day, sort_runs(day)),
                    within = diagnose(day, {.bootstrap = 20}).isolability;
  ASSERT_EQ(before.effects.size(), within.effects.size());
  for (std::size_t k = 0; k < before.effects.size(); ++k)
    EXPECT_NEAR(before.effects[k].probability_seen, within.effects[k].probability_seen, 0.05)
        << before.effects[k].effect;
}

}  // namespace
}  // namespace joulepath
