#pragma once

#include <map>
#include <vector>

#include "planner/cache/answer_cache.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// All stretches of a leg. They share one price of time, because the leg's duration is the sum of theirs.
/// Solutions are cached, so that a search over prices solves each problem once.
class LegTiming {
 public:
  explicit LegTiming(std::vector<ProfileRequest> stretches, const SharedAnswers& answers = {})
      : stretches_(std::move(stretches)), answers_(answers) {}

  const std::vector<ProfileRequest>& stretches() const { return stretches_; }
  std::vector<ProfileRequest>& stretches() { return stretches_; }

  /// Driving time (s) at a price of a second, in addition to standby; an infinite price gives the minimum
  /// time.
  double duration_s(double price_W, SolverChoice solver);

  /// Time (s) below which provably no drive of the leg is; a stretch without a proof counts as 0.
  double least_s(SolverChoice solver);

  /// Profiles of all stretches at a price; a result without a profile contains the reason.
  const std::vector<ProfileResult>& solve(double price_W, SolverChoice solver);

  /// Sets the leg's time (s): at a price of 0 or less no stretch takes longer.
  void give(double duration_s) {
    given_s_ = duration_s;
    forget();
  }

  void forget() {
    solved_.clear();
    unproven_s_.clear();
  }

  /// Whether stretches are solved as drafts (ProfileRequest::draft).
  void solve_roughly(bool roughly);

 private:
  ProfileRequest question(ProfileRequest stretch, double price_W, SolverChoice solver) const;
  /// duration_s() without the bounds of solve().
  double unproven_duration_s(double price_W, SolverChoice solver);

  std::vector<ProfileRequest> stretches_{};
  SharedAnswers answers_{};
  double given_s_{kNoLimit};
  std::map<std::pair<double, SolverChoice>, std::vector<ProfileResult>> solved_{};
  std::map<std::pair<double, SolverChoice>, double> unproven_s_{};
};

}  // namespace joulepath
