#pragma once

#include "extensions/onboard/replan/loaded_limits.hpp"
#include "extensions/onboard/replan/place_table.hpp"
#include "extensions/onboard/replan/situation.hpp"

namespace joulepath {

/// The nonlinear program of what is left of a piece from a situation on, assembled from tables in storage
/// that is kept: set() allocates nothing.
class OnlineProblem {
 public:
  /// Speed caps of a situation whose borders become nodes; further ones reach to the next nodes of the grid.
  static constexpr std::size_t kMostCaps = 16;

  OnlineProblem(const ProfileRequest& request, const Profile& plan, std::size_t nodes);
  OnlineProblem(const OnlineProblem&) = delete;
  OnlineProblem& operator=(const OnlineProblem&) = delete;

  /// `price_W`: what a second is worth where the path is blocked and the deadline cannot be judged.
  void set(const Situation& situation, double price_W);

  const nlp::Problem& problem() const { return problem_; }
  double length() const { return motion_.length(); }
  std::size_t most_nodes() const { return table_.s().size() + 2 * kMostCaps + 4; }
  std::size_t most_rows() const { return nlp::kMostRows * most_nodes(); }
  /// Up to this coordinate caps are raised to what braking from the situation's rate leaves; the
  /// situation's own place where none is.
  double raised_until() const { return raised_until_; }
  /// More is on board than planned, and more than the robot may carry.
  bool overloaded() const { return overloaded_; }

 private:
  void take_limits(const Situation& situation);
  void place_nodes(const Situation& situation);
  void add_nodes_within(std::size_t k, double from, double to);
  void add_caps(const Situation& situation);
  void raise_caps(double s);

  ProfileRequest request_;  ///< limits and caps change with the situation
  PathMotion motion_;
  PlaceTable table_;
  LoadedLimits limits_;
  nlp::Problem problem_{};
  std::vector<double> borders_{};  ///< of speed caps, ascending
  std::vector<nlp::Tightening> no_tightenings_{};
  std::vector<double> squares_{};
  double extra_kg_{};
  double raised_until_{};
  bool overloaded_{};
};

}  // namespace joulepath
