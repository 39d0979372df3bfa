#pragma once

#include "extensions/onboard/replan/online_problem.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"

// Design: docs/decisions/0402-on-the-robot.md
namespace joulepath {

/// Plans what is left of a piece of path again, from any state on it, within milliseconds: tables are made
/// once, each call assembles the rest of the program from them and starts at its last profile. After
/// construction no memory is allocated. One thread at a time.
class Replanner {
 public:
  /// The piece as it was planned, and its profile. About `nodes` nodes. Throws nothing by itself; a jerk
  /// limit is not kept (see docs/on_the_robot.md).
  Replanner(const ProfileRequest& request, const Profile& plan, std::size_t nodes = 200);

  /// Refers to this object's storage until the next call.
  const Replan& replan(const Situation& situation, const ReplanBudget& budget = {});

  double length() const { return problem_.length(); }

 private:
  void optimize(const nlp::RateEnvelope& envelope, const ReplanBudget& budget, double until_cpu_s);
  void guess(const nlp::RateEnvelope& envelope);
  void retreat(const nlp::RateEnvelope& envelope);
  [[nodiscard]] bool keeps_everything(const std::vector<double>& b) const;
  void stop(const Situation& situation, const nlp::Blocked& blocked);
  void stand(const Situation& situation);
  void finish(const Situation& situation);
  void profile_from_nodes();
  void remember();
  [[nodiscard]] double remembered(double s) const;

  OnlineProblem problem_;
  nlp::EnvelopeSweeps sweeps_{};
  nlp::FastSolver solver_{};
  std::vector<double> b_{}, guess_{};            ///< squares of the rate at the nodes
  std::vector<double> s_, last_s_{}, last_b_{};  ///< nodes of the answer; the last profile
  double price_W_{};                             ///< of time, of the last profile
  Profile profile_{};
  Replan answer_{};
};

}  // namespace joulepath
