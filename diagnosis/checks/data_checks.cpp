#include "diagnosis/checks/data_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

#include "diagnosis/checks/dead_channels.hpp"
#include "diagnosis/checks/effectiveness.hpp"
#include "diagnosis/checks/faults.hpp"
#include "diagnosis/checks/noisy_units.hpp"
#include "diagnosis/checks/odd_laws.hpp"
#include "diagnosis/checks/plausible.hpp"
#include "diagnosis/checks/relations.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/text_of_list.hpp"
// Design: docs/decisions/0500-data-checks.md
namespace joulepath {
namespace {

/// A run with the repairs found so far.
struct Examined {
  const RunSignals* logged{};
  std::optional<Run> mended{};  ///< absent: as logged
  std::optional<RunSignals> mended_signals{};
  Relations relations{};
  bool lost{};  ///< a channel without which nothing can be told is dead

  [[nodiscard]] std::size_t index() const { return logged->run_index; }
  [[nodiscard]] const RunSignals& signals() const { return mended_signals ? *mended_signals : *logged; }
};

bool has_doubtful(const Relations& relations) {
  return std::ranges::any_of(relations, [](const auto& relation) {
    return relation && !(relation->unexplained <= relation->doubtful);
  });
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

class DataCheckSearch {
 public:
  DataCheckSearch(const Dataset& dataset, const RunsByUse& runs) : dataset_(dataset), options_(runs.options) {
    for (const RunSignals& signals : runs.signals) runs_.push_back({.logged = &signals});
    parallel_for(runs_.size(), [&](std::size_t r) {
      runs_[r].relations = relations_of(runs_[r].signals(), dataset_.robot);
    });
  }

  /// Order of the search: channels of one value, then sides, signs and units, then other dead channels, then
  /// other factors, then one run against the others. A swapped or tiny channel follows its quantity as little
  /// as a dead one, but has more than one value, and a factor could imitate a dead channel.
  std::vector<DataCheck> find() {
    find_dead(true);
    find_faults(false);
    find_dead(false);
    find_faults(true);
    find_odd_runs();
    return std::move(checks_);
  }

 private:
  const Run& run_of(const Examined& examined) const {
    return examined.mended ? *examined.mended : dataset_.runs[examined.index()];
  }

  Relations relations_with(const Examined& examined, const std::vector<ColumnRepair>& columns,
                           double freedom = 1.0) const {
    const Run run = repaired(run_of(examined), columns, dataset_.robot.geometry);
    if (!has_usable_log(run))
      return Relations(examined.relations.size());  // another clock makes it too short
    return relations_of(make_run_signals(run, examined.index(), dataset_.robot, options_), dataset_.robot,
                        freedom);
  }

  void mend(Examined& examined, const std::vector<ColumnRepair>& columns) {
    examined.mended = repaired(run_of(examined), columns, dataset_.robot.geometry);
    examined.mended_signals = make_run_signals(*examined.mended, examined.index(), dataset_.robot, options_);
    examined.relations = relations_of(examined.signals(), dataset_.robot);
  }

  /// Mends the runs of a fault and reports it.
  void settle(const Fault& fault, const std::vector<std::size_t>& which, std::string evidence) {
    for (std::size_t r : which) mend(runs_[r], fault.columns);
    report({.channel = fault.channel,
            .kind = fault.kind,
            .evidence = std::move(evidence),
            .columns = fault.columns},
           which);
  }

  void report(DataCheck check, const std::vector<std::size_t>& which) {
    for (std::size_t r : which) {
      check.runs.push_back(runs_[r].index());
      if (which.size() < runs_.size()) append_item(check.run, dataset_.runs[runs_[r].index()].name);
    }
    checks_.push_back(std::move(check));
  }

  void find_faults(bool with_factors) {
    for (int k = 0; k < kMostFaults; ++k)
      if (!find_fault(with_factors)) break;
  }

  /// Speeds that no wheel has (counts, another unit): what the other channels ask for is unknown.
  bool has_wild_wheels(std::size_t r) const {
    return std::ranges::any_of(implausible_channels(run_of(runs_[r]), dataset_.robot),
                               [](const auto& found) { return found.channel.starts_with("wheel_speed_"); });
  }

  /// Of one value throughout, or all.
  void find_dead(bool of_one_value) {
    std::vector<std::vector<FollowedChannel>> channels(runs_.size());
    parallel_for(runs_.size(),
                 [&](std::size_t r) { channels[r] = followed_channels(runs_[r].signals(), dataset_.robot); });
    std::map<std::vector<std::string>, std::map<std::size_t, FollowedChannel>> found;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      if (!of_one_value && has_wild_wheels(r)) continue;
      for (FollowedChannel& channel : channels[r]) {
        channel.is_dead = channel.is_dead && (channel.is_constant || !of_one_value);
        found[channel.columns].emplace(r, channel);
      }
    }
    for (const auto& [columns, runs] : found)
      if (const std::vector<std::size_t> dead = dead_runs(runs); !dead.empty()) report_dead(runs, dead);
  }

  void report_dead(const std::map<std::size_t, FollowedChannel>& runs, const std::vector<std::size_t>& dead) {
    const FollowedChannel& first = runs.at(dead.front());
    DataCheck check{.kind = "dead"};
    for (const std::string& column : first.columns) {
      append_item(check.channel, column);
      if (!first.needed) check.columns.push_back({.column = column, .absent = true});
    }
    const std::string& run = dataset_.runs[runs_[dead.front()].index()].name;
    if (first.is_constant)
      check.evidence = std::string("reads one value throughout, ") +
                       (first.is_dead ? "where the other channels ask for a change"
                                      : "and varies in runs with less motion");
    else
      check.evidence =
          "shows " + percent(std::abs(first.followed)) + " of the change that the other channels ask for";
    check.evidence += " (" + run + ")";
    for (std::size_t r : dead) {
      if (first.needed)
        runs_[r].lost = true;
      else
        mend(runs_[r], check.columns);
    }
    report(std::move(check), dead);
  }

  struct Found {
    Fault fault{};
    std::vector<std::size_t> which{};
    double nats{};
  };

  /// The fault whose repair explains most, summed over the runs that it repairs.
  std::optional<Found> best_fault(const std::vector<std::size_t>& broken, bool with_factors) const {
    std::optional<Found> best;
    for (const Fault& fault : possible_faults(run_of(runs_[broken.front()]))) {
      if (fault.kind == "scaled" && !with_factors) continue;
      std::vector<Effectiveness> effect(broken.size());
      parallel_for(broken.size(), [&](std::size_t k) {
        const Examined& examined = runs_[broken[k]];
        effect[k] =
            compare(examined.relations, relations_with(examined, fault.columns), fault.kind == "scaled");
      });
      Found found{.fault = fault, .nats = fault.kind == "scaled" ? -kUnusualFault : 0.0};
      for (std::size_t k = 0; k < broken.size(); ++k)
        if (effect[k].repairs) found.which.push_back(broken[k]), found.nats += effect[k].nats;
      if (!found.which.empty() && (!best || found.nats > best->nats)) best = found;
    }
    return best;
  }

  /// Extends a fault to all runs with its columns, unless it contradicts one of them.
  void widen(Found& found) const {
    std::vector<char> against(runs_.size(), 0);
    parallel_for(runs_.size(), [&](std::size_t r) {
      if (runs_[r].lost || std::ranges::find(found.which, r) != found.which.end()) return;
      if (!may_have(runs_[r], found.fault)) return;
      against[r] =
          compare(runs_[r].relations, relations_with(runs_[r], found.fault.columns)).contradicts ? 1 : 0;
    });
    if (std::ranges::find(against, 1) != against.end()) return;
    found.which.clear();
    for (std::size_t r = 0; r < runs_.size(); ++r)
      if (may_have(runs_[r], found.fault)) found.which.push_back(r);
  }

  /// Whether the run has the fault's columns and can be used after the repair.
  bool may_have(const Examined& examined, const Fault& fault) const {
    const std::vector<Fault> possible = possible_faults(run_of(examined));
    return std::ranges::any_of(possible,
                               [&](const Fault& other) { return other.channel == fault.channel; }) &&
           has_usable_log(repaired(run_of(examined), fault.columns, dataset_.robot.geometry));
  }

  /// Refines a factor that is not a unit conversion: the factor at which relations with fixed coefficients
  /// fit best.
  void refine(Found& found) const {
    const Examined& examined = runs_[found.which.front()];
    const double first = found.fault.columns.front().scale;
    double best = first, least = std::numeric_limits<double>::infinity();
    for (int step = -40; step <= 40; ++step) {
      const double factor = first * std::exp(0.02 * step);
      double misfit = 0;
      for (const auto& relation :
           relations_with(examined, with_factor(found.fault, factor).columns, kRefinementFreedom))
        if (relation) misfit += std::log(relation->unexplained + kExactRelation);
      if (misfit < least) least = misfit, best = factor;
    }
    found.fault = with_factor(found.fault, best);
  }

  /// Holds each run against the others, by coefficients that are nearly those of the robot file: what no
  /// other run needs is a fault of the run where its repair makes every odd law as sound as in the others.
  void find_odd_runs() {
    if (runs_.size() < kLeastRunsToName) return;
    std::vector<Relations> relations(runs_.size());
    parallel_for(runs_.size(), [&](std::size_t r) {
      relations[r] = relations_of(runs_[r].signals(), dataset_.robot, kComparedFreedom);
    });
    for (std::size_t r = 0; r < runs_.size(); ++r)
      if (!runs_[r].lost) find_odd_run(relations, r);
  }

  void find_odd_run(const std::vector<Relations>& relations, std::size_t r) {
    const OddLaws laws = odd_laws(relations, r);
    if (!laws.suspect) return;
    const auto repair = [&](const Fault& fault) {
      return repair_gain(laws, relations[r], relations_with(runs_[r], fault.columns, kComparedFreedom));
    };
    std::optional<Found> best;
    for (const Fault& fault : possible_faults(run_of(runs_[r])))
      if (const std::optional<double> nats = repair(fault); nats && (!best || *nats > best->nats))
        best = Found{.fault = fault, .which = {r}, .nats = *nats};
    if (!best) return;
    if (best->fault.kind == "scaled") refine(*best);
    if (may_be_effect(best->fault) || !repair(best->fault)) return;
    const std::size_t law = laws.odd.front();
    settle(best->fault, best->which,
           relations[r][law]->law + ": " + percent(relations[r][law]->unexplained) +
               " unexplained as logged, at most " + percent(laws.most[law]) +
               " in the other runs; the repair makes every law as sound as there");
  }

  static bool may_be_effect(const Fault& fault) {
    const double factor = fault.columns.front().scale;
    return fault.kind == "scaled" && factor > 1 / kMostEffectFactor && factor < kMostEffectFactor;
  }

  bool find_fault(bool with_factors) {
    std::vector<std::size_t> broken;
    for (std::size_t r = 0; r < runs_.size(); ++r)
      if (!runs_[r].lost && has_doubtful(runs_[r].relations)) broken.push_back(r);
    if (broken.empty()) return false;
    std::optional<Found> found = best_fault(broken, with_factors);
    if (!found) return false;
    const std::size_t shown = found->which.front();
    if (found->fault.kind == "scaled") refine(*found);
    if (may_be_effect(found->fault)) return false;
    const Relations before = runs_[shown].relations,
                    after = relations_with(runs_[shown], found->fault.columns);
    const std::size_t most = compare(before, after, found->fault.kind == "scaled").most;
    widen(*found);
    settle(found->fault, found->which,
           before[most]->law + ": " + percent(before[most]->unexplained) + " unexplained as logged, " +
               percent(after[most]->unexplained) + " with the repair (" +
               dataset_.runs[runs_[shown].index()].name + ")");
    return true;
  }

  const Dataset& dataset_;
  SignalOptions options_{};
  std::vector<Examined> runs_{};
  std::vector<DataCheck> checks_{};
};

bool is_covered(const std::vector<DataCheck>& checks, std::size_t run, const std::string& channel) {
  return std::ranges::any_of(checks, [&](const DataCheck& check) {
    return check.channel.find(channel) != std::string::npos &&
           std::ranges::find(check.runs, run) != check.runs.end();
  });
}

/// Adds units that only the noise shows.
void add_noisy_units(const Dataset& dataset, std::vector<DataCheck>& checks) {
  for (DataCheck& check : noisy_units(dataset))
    if (!is_covered(checks, check.runs.front(), check.columns.front().column))
      checks.push_back(std::move(check));
}

/// Adds values that no robot has and that no repair above explains.
void add_implausible(const Dataset& dataset, std::vector<DataCheck>& checks) {
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    for (const Implausible& channel : implausible_channels(dataset.runs[r], dataset.robot))
      if (!is_covered(checks, r, channel.channel))
        checks.push_back(
            {.runs = {r},
             .run = dataset.runs[r].name,
             .channel = channel.channel,
             .kind = "unit",
             .evidence = channel.found + ", where a robot has " + channel.accepted + ": " + channel.hint});
}

}  // namespace

std::vector<DataCheck> check_data(const Dataset& dataset, const RunsByUse& runs) {
  std::vector<DataCheck> checks = DataCheckSearch(dataset, runs).find();
  add_noisy_units(dataset, checks);
  add_implausible(dataset, checks);
  return checks;
}

}  // namespace joulepath
