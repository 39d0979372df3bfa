// Lower bounds of plans against the energies of finer profiles that keep every limit, on seeded random
// problems: a bound above such an energy would be false.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"
#include "tests/support/with_room.hpp"

namespace joulepath {
namespace {

constexpr unsigned kSeed = 20261122;
constexpr double kRoom = 1e-6;    ///< by which the finer profile's limits are smaller
constexpr double kStrict = 1e-9;  ///< relative violation that a profile within the limits may have
constexpr TimeMode kModes[] = {TimeMode::free_time, TimeMode::time_budget, TimeMode::fixed_time,
                               TimeMode::time_price};

/// What one kind of problem showed.
struct Group {
  int problems{}, unsolved{}, loose{}, exceptions{}, optimal{}, local{};
  std::vector<double> gap{}, excess{};
};

double share(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

/// Adds a time goal; false where there is no fastest drive.
bool set_time(ProfileRequest& request, testing::RandomProfiles& random) {
  const double factor = random.uniform(1.02, 2), price_W = random.uniform(0.1, 20);
  const TimeMode mode = kModes[random.choice(4)];
  request.time = {TimeMode::minimum_time};
  ProfileRequest draft = request;
  draft.limits.jerk_m_s3 = kNoLimit;
  draft.draft = true;
  const ProfileResult fastest = solve_profile(draft);
  if (!fastest.profile) return false;
  const double slower = std::isfinite(request.limits.jerk_m_s3) ? 1.3 : 1.0;
  request.time = {mode, factor * slower * fastest.profile->duration_s(), price_W};
  if (mode == TimeMode::time_price) request.time.duration_s = kNoLimit;
  return true;
}

void look(const ProfileRequest& request, std::size_t fine_nodes, Group& group) {
  ++group.problems;
  const ProfileResult result = solve_profile(request);
  if (!result.profile) {
    ++group.unsolved;
    return;
  }
  ProfileRequest finer = testing::with_room(request, kRoom);
  finer.nodes = fine_nodes;
  const ProfileResult other = solve_profile(finer);
  const bool priced = request.time.mode == TimeMode::time_price;
  const double price_W = priced ? request.time.price_W : 0.0;
  const ReplayResult own = replay(request, *result.profile);
  group.gap.push_back(0.01 * result.summary.gap_percent);
  group.optimal += result.summary.status == SolveStatus::optimal;
  group.local += result.summary.local;
  if (!other.profile) return;
  const ReplayResult strict = replay(request, *other.profile);
  group.loose += strict.worst_violation > kStrict;
  if (strict.worst_violation > kStrict) return;
  const double more_J = strict.energy_J - own.energy_J + price_W * (strict.duration_s - own.duration_s);
  group.exceptions += own.energy_J + more_J < result.summary.lower_bound_J;
  group.excess.push_back(-more_J / own.energy_J);
}

std::string row(const std::string& name, const Group& g) {
  char text[400];
  std::snprintf(
      text, sizeof text, "| %s | %d | %d | %d | **%d** | %d, %d | %.1e, %.1e, %.1e | %.1e, %.1e, %.1e |\n",
      name.c_str(), g.problems, g.unsolved, g.loose, g.exceptions, g.optimal, g.local, share(g.gap, 0.5),
      share(g.gap, 0.95), share(g.gap, 1), share(g.excess, 0.5), share(g.excess, 0.95), share(g.excess, 1));
  return text;
}

int run(const char* file, int count, int jerk_count, std::size_t fine_nodes, const char* how) {
  testing::RandomProfiles random(kSeed);
  std::map<std::string, Group> groups;
  for (int i = 0; i < count + jerk_count; ++i) {
    const testing::PathClass path_class = testing::kPathClasses[i % 4];
    ProfileRequest request = random.next(path_class);
    request.solver = SolverChoice::fast;
    const bool standby = random.choice(4) != 0, jerk = i >= count;
    if (!standby) request.plant.robot.power.standby_W = 0;
    if (jerk) request.limits.jerk_m_s3 = random.uniform(0.3, 2);
    if (!set_time(request, random)) continue;
    std::string name = jerk ? "jerk limit, " : standby ? "with standby, " : "without standby, ";
    name += testing::kPathClassNames[i % 4];
    look(request, jerk ? 400 : fine_nodes, groups[name]);
    if (i % 100 == 99) std::fprintf(stderr, "%d\n", i + 1);
  }
  int exceptions = 0;
  std::ofstream out(file);
  out << "# Lower bounds of plans\n\n"
      << how << " Finer profiles: " << fine_nodes << " nodes (400 with a jerk limit), within limits that are "
      << kRoom << " smaller; only those whose replay keeps every limit to " << kStrict
      << " count. Gaps and excesses are relative to the plan's energy; time is free, at most, exactly given "
         "or "
         "at a price; regeneration 0, 0.6 or 1, by wheel or by bus.\n\n"
      << "| problems | number | no plan | finer profile not strict | bound above the finer profile | "
         "optimal, "
         "local | claimed gap: median, p95, max | above the finer profile: median, p95, max |\n"
      << "|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, group] : groups) {
    out << row(name, group);
    exceptions += group.exceptions;
  }
  return exceptions == 0 ? 0 : 1;
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  return joulepath::run(argv[1], std::atoi(argv[2]), std::atoi(argv[3]),
                        static_cast<std::size_t>(std::atoi(argv[4])), argv[5]);
}
