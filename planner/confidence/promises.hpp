#pragma once

#include <vector>

#include "planner/confidence/margins.hpp"

namespace joulepath {

/// What draws of the robot make of a plan.
struct Sample {
  std::vector<PlanDemand> drawn{};
  PlanDemand nominal{};
  std::size_t kept{};  ///< draws that keep all promises together
  std::uint64_t seed{};

  [[nodiscard]] double share() const { return static_cast<double>(kept) / static_cast<double>(drawn.size()); }
};

/// Judges plans of a mission by draws of the robot. It keeps references to all arguments.
class PromiseJudge {
 public:
  PromiseJudge(const MissionRequest& mission, const Robot& robot, const Plant& plant, std::size_t draws)
      : mission_(mission), robot_(robot), plant_(plant), draws_(draws) {}

  /// By derivatives, with draws that all plans see: to find margins.
  [[nodiscard]] Sample estimated(const Plan& plan) const;

  /// By the model, with the draws of a seed above 0.
  [[nodiscard]] Sample judged(const Plan& plan, std::uint64_t seed) const;

  /// The share of a judged sample that keeps each promise on its own: arrival at stops with a deadline, the
  /// reserve, and each limit that the plan uses.
  [[nodiscard]] std::vector<Promise> promises(const Plan& plan, const Sample& sample,
                                              const Margins& margins) const;

 private:
  PlanDemands demands_of(const Plan& plan) const;
  /// `demands_of_some`: of errors, a column for each draw.
  template <class DemandsOfSome>
  Sample sample_of(const PlanDemand& nominal, PlantDraws& draws, const DemandsOfSome& demands_of_some) const;
  const std::vector<LegRequest>& legs_of(const Plan& plan) const;
  bool has_deadline(const Plan& plan) const;
  bool arrives(const Plan& plan, const PlanDemands& demands, const PlantDraw& draw) const;
  double arrival_share(const Plan& plan, const Sample& sample) const;

  const MissionRequest& mission_;
  const Robot& robot_;
  const Plant& plant_;
  std::size_t draws_;
};

}  // namespace joulepath
