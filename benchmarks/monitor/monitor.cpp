// The monitor on simulated days: false alarms where nothing is hidden, delay and size of payload steps, other
// causes that must not pass for payload, CPU time of a row.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>
#include <string>

#include "extensions/onboard/tests/simulated_day.hpp"

namespace joulepath {
namespace {

constexpr double kHour_s = 3600;

std::string format(const char* pattern, auto... values) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

struct Watched {
  std::vector<CauseChange> changes{};
  double hours{};
};

Watched watch(const testing::Day& day, const Trajectory& log) {
  CauseWatch cause_watch(testing::nomad(), MonitorOptions{}.hours_per_false_alarm);
  Watched result{.hours = (log.time_s.back() - log.time_s.front()) / kHour_s};
  for (std::size_t k = 0; k < log.size(); ++k)
    if (const auto change = cause_watch.add(testing::row_of(log, k, day.payload_kg), day.payload_kg))
      result.changes.push_back(*change);
  return result;
}

long alarms_of(const Watched& watched, bool payload) {
  long count = 0;
  for (const CauseChange& change : watched.changes) count += change.payload == payload;
  return count;
}

std::string null_rows(double hours) {
  double driven_h = 0;
  long payload = 0, other = 0;
  for (unsigned seed = 1; driven_h < hours; ++seed) {
    const testing::Day day = testing::day(460, seed);
    const Watched watched = watch(day, testing::drive(day, {}, seed).log);
    driven_h += watched.hours;
    payload += alarms_of(watched, true);
    other += alarms_of(watched, false);
  }
  return format("| nothing hidden, %.0f h in days of 2 h | %ld | %ld |\n", driven_h, payload, other);
}

/// One cause of the catalog that resists or belongs to the floor, of up to three typical sizes, all day long.
std::string other_rows(int days) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> size(0.5, 3.0);
  double driven_h = 0;
  long payload = 0, other = 0;
  for (int k = 0; k < days; ++k) {
    std::vector<const EffectDescription*> usable;
    for (const EffectDescription& effect : effect_catalog())
      if ((effect.info.kind == "resistance" || effect.info.kind == "floor") && !effect.has_cells)
        usable.push_back(&effect);
    const EffectDescription& effect = *usable[random() % usable.size()];
    EffectSetting setting{.name = std::string(effect.info.name)};
    for (const ParameterDescription& parameter : effect.parameters)
      setting.parameters[parameter.name] =
          parameter.role == ParameterRole::strength
              ? std::min(parameter.max, size(random) * typical_size(parameter, testing::nomad()))
              : typical_size(parameter, testing::nomad());
    if (effect.has_side) setting.side = Side::left;
    if (effect.has_region)
      setting.parameters.insert_or_assign("x_min_m", 0.0),
          setting.parameters.insert_or_assign("x_max_m", 1.5),
          setting.parameters.insert_or_assign("y_min_m", -9.0),
          setting.parameters.insert_or_assign("y_max_m", 9.0);
    const testing::Day day = testing::day(115, static_cast<unsigned>(k));
    const Watched watched = watch(day, testing::drive(day, {1.0, 0, {setting}}, random()).log);
    driven_h += watched.hours;
    payload += alarms_of(watched, true) > 0;
    other += alarms_of(watched, false) > 0;
    if (alarms_of(watched, true) > 0)
      std::fprintf(stderr, "%s %g: payload %.2f kg\n", setting.name.c_str(),
                   setting.parameters.begin()->second, watched.changes.front().extra_kg.value);
  }
  return format("| another cause each day, %d days, %.0f h (days with an alarm) | %ld | %ld |\n", days,
                driven_h, payload, other);
}

std::string step_row(double extra_kg, int repeats) {
  double delay_s = 0, worst_s = 0, off_kg = 0;
  int found = 0, covered = 0, named_otherwise = 0;
  for (int k = 0; k < repeats; ++k) {
    const testing::Day day = testing::day(115, static_cast<unsigned>(k + 1));
    const double from_share = 0.3 + 0.01 * k;
    const double step_s = from_share * day.motion.trajectory.time_s.back();
    const Watched watched =
        watch(day, testing::drive(day, {from_share, extra_kg, {}}, static_cast<unsigned>(k)).log);
    named_otherwise += alarms_of(watched, false) > 0;
    for (const CauseChange& change : watched.changes) {
      if (!change.payload || change.time_s < step_s) continue;
      ++found;
      delay_s += change.time_s - step_s;
      worst_s = std::max(worst_s, change.time_s - step_s);
      off_kg += std::abs(change.extra_kg.value - extra_kg);
      const double sigma =
          std::hypot(change.extra_kg.sigma, 0.01 * testing::nomad().total_mass_kg(0) / 1.645);
      covered += std::abs(change.extra_kg.value - extra_kg) <= 1.96 * sigma;
      break;
    }
  }
  return format("| %+.1f kg | %d of %d | %.0f s | %.0f s | %.2f kg | %d of %d | %d |\n", extra_kg, found,
                repeats, delay_s / found, worst_s, off_kg / found, covered, found, named_otherwise);
}

std::string speed_row() {
  const testing::Day day = testing::day(115);
  const Trajectory log = testing::drive(day, {}).log;
  const std::clock_t before = std::clock();
  (void)watch(day, log);
  const double cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return format("CPU time of a row: %.2f us (%zu rows).\n", 1e6 * cpu_s / static_cast<double>(log.size()),
                log.size());
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s FILE NULL_HOURS REPEATS PROVENANCE\n", argv[0]);
    return 2;
  }
  const double hours = std::atof(argv[2]);
  const int repeats = std::atoi(argv[3]);
  std::string text =
      "# The monitor, measured\n\n" + std::string(argv[4]) +
      "\nA simulated robot of 24 kg drives 4 to 7 m, stops, turns in place and drives back; 4 kg are stated; "
      "sensors as `typical_sensors()`, 50 rows per second. False alarms: at most one in 100 h is "
      "promised.\n\n| day | `payload` | `not_payload` |\n|---|---|---|\n";
  text += joulepath::null_rows(hours);
  text += joulepath::other_rows(repeats * 3);
  text +=
      "\n| step of the payload | found | mean delay | worst | mean error | in the 95 % interval | days with "
      "`not_payload` |\n|---|---|---|---|---|---|---|\n";
  for (const double extra_kg : {0.5, 1.0, 2.0, 5.0, 10.0, -0.5, -1.0, -3.0})
    text += joulepath::step_row(extra_kg, repeats);
  text += "\n" + joulepath::speed_row();
  std::ofstream(argv[1]) << text;
  std::fputs(text.c_str(), stdout);
  return 0;
}
