#include "scenarios/result_files/gap_after.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/text/significant.hpp"
#include "scenarios/text/three_digits.hpp"

namespace joulepath {
namespace {

/// "closed 92 % (95 %: 88 to 96 %)".
std::string closed_words(double fraction, const Range95& range) {
  return three_digits(100 * fraction) + " % (95 %: " + three_digits(100 * range.first) + " to " +
         three_digits(100 * range.second) + " %)";
}

}  // namespace

std::string after_sentence(const GapAfter& after, const Forecast& forecast) {
  const EnergyGap& energy = after.gap.energy;
  if (energy.before_J <= 0) return "No energy is measured on the runs that judge.";
  return std::string("The simulator's energy gap ") + (energy.after_J > energy.before_J ? "grew" : "shrank") +
         " from " + three_digits(energy.before_percent) + " % to " + three_digits(energy.after_percent) +
         " % on " + std::to_string(after.runs.size()) + " runs (noise floor " +
         three_digits(energy.noise_floor_percent) + " %): closed " +
         closed_words(energy.shrink_fraction, energy.shrink_interval_95) + "; forecast " +
         closed_words(forecast.shrink_fraction, forecast.shrink_interval_95) + ".";
}

std::string gap_after_json(const GapAfter& after, const Forecast& forecast) {
  const auto& [low, high] = forecast.shrink_interval_95;
  nlohmann::ordered_json json{{"schema", "joulepath/after/1"},
                              {"sentence", after_sentence(after, forecast)},
                              {"causes", forecast.causes},
                              {"gap", gap_json(after.gap)},
                              {"forecast",
                               {{"shrink_fraction", six_digits(forecast.shrink_fraction)},
                                {"shrink_interval_95", {six_digits(low), six_digits(high)}}}},
                              {"validation", {{"runs", after.runs}, {"method", forecast.method}}}};
  for (const char* of_the_first : {"detectable_percent", "hard_to_see"})
    json["gap"]["energy"].erase(of_the_first);
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace joulepath
