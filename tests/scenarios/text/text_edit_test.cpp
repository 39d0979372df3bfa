#include "scenarios/text/text_edit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "scenarios/text/json_value.hpp"

namespace joulepath {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson values_of(const std::string& text) {
  return json_of(Document::parse(text, "mission.yaml").root().value());
}

std::string edited(const std::string& text, const std::function<void(OrderedJson&)>& edit) {
  OrderedJson wanted = values_of(text);
  edit(wanted);
  const std::string result = with_values(text, "mission.yaml", wanted);
  EXPECT_EQ(nlohmann::json(values_of(result)), nlohmann::json(wanted)) << result;
  return result;
}

constexpr const char* kMission = R"(schema: joulepath/mission/1
# a round
robot: ../robots/robot.yaml   # ours
stations:
  dock: {x_m: 2.0, y_m: -23.50, heading_rad: 0.0, charger_W: 200}  # by the door
  shelf: {x_m: -6.9, y_m: 1.10e1}
start: {station: dock}
legs:
  - {to: shelf, payload_kg: 0.0, dwell_s: 20}   # out
  # and back, loaded
  - to: dock
    payload_kg: {from: 8, to: 2}  # spraying
    deadline_s: 80
  - {path: {bezier_m: [[[0, 0], [2.7, 0], [2.7, 0], [2.7, 2.7]]], frame: start}}
objective: {minimize: energy}
)";

TEST(TextEdit, LeavesATextWithTheSameValuesAlone) {
  EXPECT_EQ(edited(kMission, [](OrderedJson&) {}), kMission);
  EXPECT_EQ(edited(kMission, [](OrderedJson& mission) { mission["legs"][0]["payload_kg"] = 0; }), kMission);
}

TEST(TextEdit, ReplacesOnlyTheTextOfANumber) {
  std::string expected = kMission;
  expected.replace(expected.find("-6.9"), 4, "-7.25");
  EXPECT_EQ(edited(kMission, [](OrderedJson& mission) { mission["stations"]["shelf"]["x_m"] = -7.25; }),
            expected);
  expected = kMission;
  expected.replace(expected.find("deadline_s: 80"), 14, "deadline_s: 90.5");
  EXPECT_EQ(edited(kMission, [](OrderedJson& mission) { mission["legs"][1]["deadline_s"] = 90.5; }),
            expected);
}

TEST(TextEdit, AddsAndRemovesKeysInTheNotationOfTheirMap) {
  const std::string flow =
      edited(kMission, [](OrderedJson& mission) { mission["objective"]["deadline_s"] = 120; });
  EXPECT_NE(flow.find("objective: {minimize: energy, deadline_s: 120}"), std::string::npos) << flow;
  const std::string block = edited(kMission, [](OrderedJson& mission) { mission["legs"][1]["dwell_s"] = 5; });
  EXPECT_NE(block.find("    deadline_s: 80\n    dwell_s: 5\n"), std::string::npos) << block;
  const std::string less =
      edited(kMission, [](OrderedJson& mission) { mission["legs"][1].erase("payload_kg"); });
  EXPECT_EQ(less.find("spraying"), std::string::npos) << less;
  EXPECT_NE(less.find("  - to: dock\n    deadline_s: 80\n"), std::string::npos) << less;
  edited(kMission, [](OrderedJson& mission) { mission["legs"][1].erase("to"); });
  edited(kMission, [](OrderedJson& mission) { mission["stations"]["dock"].erase("charger_W"); });
  edited(kMission, [](OrderedJson& mission) { mission.erase("objective"); });
  edited(kMission, [](OrderedJson& mission) { mission["clearance_m"] = 0.05; });
}

TEST(TextEdit, MovesItemsOfAListWithTheirOwnTextAndComments) {
  const std::string text =
      edited(kMission, [](OrderedJson& mission) { std::swap(mission["legs"][0], mission["legs"][2]); });
  for (const char* kept : {"dwell_s: 20}   # out\n", "# and back, loaded\n", "# spraying\n"})
    EXPECT_NE(text.find(kept), std::string::npos) << text;
}

TEST(TextEdit, InsertsAndRemovesItems) {
  const std::string more = edited(kMission, [](OrderedJson& mission) {
    mission["stations"]["gate"] = {{"x_m", 1}, {"y_m", 2.5}};
    mission["legs"].insert(mission["legs"].begin() + 1, OrderedJson{{"to", "gate"}, {"payload_kg", 3}});
  });
  EXPECT_NE(more.find("  - {to: gate, payload_kg: 3}\n"), std::string::npos) << more;
  EXPECT_NE(more.find("  gate: {x_m: 1, y_m: 2.5}\n"), std::string::npos) << more;
  edited(kMission, [](OrderedJson& mission) { mission["legs"].erase(2); });
  edited(kMission, [](OrderedJson& mission) {
    mission["legs"][2]["path"]["bezier_m"].push_back(mission["legs"][2]["path"]["bezier_m"][0]);
  });
}

TEST(TextEdit, ReadsBackAsWantedAfterRandomEdits) {
  std::mt19937 random(5);
  std::string text = kMission;
  for (int k = 0; k < 300; ++k)
    text = edited(text, [&](OrderedJson& mission) {
      OrderedJson& legs = mission["legs"];
      const std::size_t at = random() % legs.size();
      switch (random() % 7) {
        case 0:
          legs[at]["payload_kg"] = 0.25 * static_cast<double>(random() % 40);
          break;
        case 1:
          legs[at]["dwell_s"] = random() % 30;
          break;
        case 2:
          legs[at].erase("dwell_s");
          break;
        case 3:
          std::swap(legs[at], legs[random() % legs.size()]);
          break;
        case 4:
          if (legs.size() > 1) legs.erase(at);
          break;
        case 5:
          if (legs.size() < 8)
            legs.insert(legs.begin() + static_cast<long>(at), OrderedJson{{"to", "shelf"}, {"dwell_s", k}});
          break;
        default:
          mission["stations"]["stop_" + std::to_string(random() % 4)] = {{"x_m", 0.5 * k}, {"y_m", -1}};
      }
    });
  EXPECT_NE(text.find("# a round\nrobot: ../robots/robot.yaml   # ours\n"), std::string::npos) << text;
  EXPECT_NE(text.find("# by the door"), std::string::npos) << text;
}

TEST(TextEdit, RejectsNotationsThatItCannotKeep) {
  const std::string text = "a: &x {k: 1}\nb: *x\n";
  OrderedJson wanted = values_of(text);
  wanted["b"]["k"] = 2;
  EXPECT_THROW(static_cast<void>(with_values(text, "mission.yaml", wanted)), ConfigError);
}

std::string with_crlf(const std::string& text) {
  std::string lines;
  for (const char c : text) lines += c == '\n' ? "\r\n" : std::string(1, c);
  return lines;
}

TEST(TextEdit, AFileOfOtherLineEndsIsEditedAsTheSame) {
  const std::vector<std::function<void(OrderedJson&)>> edits{
      [](OrderedJson& mission) {
        mission["legs"].push_back({{"to", "dock"}, {"payload_kg", 1.5}});
      },
      [](OrderedJson& mission) {
        mission["legs"].insert(mission["legs"].begin(), {{"to", "dock"}});
      },
      [](OrderedJson& mission) { std::reverse(mission["legs"].begin(), mission["legs"].end()); },
      [](OrderedJson& mission) { mission["legs"].erase(1); },
      [](OrderedJson& mission) { mission["clearance_m"] = 0.2; },
      [](OrderedJson& mission) { mission["stations"]["dock"]["x_m"] = 2.5; },
      [](OrderedJson& mission) { mission.erase("start"); }};
  for (const std::string& text :
       {std::string(kMission), std::string(kMission).substr(0, std::string(kMission).size() - 1)})
    for (const auto& edit : edits) EXPECT_EQ(edited(with_crlf(text), edit), with_crlf(edited(text, edit)));
}

}  // namespace
}  // namespace joulepath
