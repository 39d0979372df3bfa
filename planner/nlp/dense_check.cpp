#include "planner/nlp/dense_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "planner/limit_check.hpp"
#include "planner/segment_energy.hpp"

namespace joulepath::nlp {
namespace {

constexpr int kLooks = 8;            ///< per segment
constexpr double kTolerated = 3e-7;  ///< relative
constexpr double kCoarse = 5e-3;     ///< a violation beyond this asks for a node, not for tightening alone

/// Energy of segment k as the problem counts it.
double transcribed_energy_J(const Problem& problem, const Profile& profile, std::size_t k) {
  const double b0 = profile.rate[k] * profile.rate[k], b1 = profile.rate[k + 1] * profile.rate[k + 1];
  const std::array<double, 2> energy = Energy::both(plain_interval(problem.segments[k], b0, b1));
  const double weight = 1 - problem.request->plant.robot.power.regeneration_efficiency;
  return energy[0] + energy[1] + weight * (std::max(0.0, -energy[0]) + std::max(0.0, -energy[1]));
}

}  // namespace

DenseCheck check_densely(const Problem& problem, const PathMotion& motion, const Profile& profile,
                         double accuracy) {
  const ProfileRequest& request = *problem.request;
  const std::size_t count = problem.segment_count();
  DenseCheck result{.cut = std::vector<bool>(count, false)};
  std::vector<double> error_J(count);
  for (std::size_t k = 0; k < count; ++k) {
    std::map<std::string_view, double> worst;
    const double from = profile.s[k], ds = profile.s[k + 1] - from;
    for (int i = 0; i <= kLooks; ++i) {
      ProfileState state =
          profile.at_s(from + ds * std::clamp(static_cast<double>(i) / kLooks, 1e-7, 1 - 1e-7));
      for_each_limit_use(motion, request.limits, request.speed_caps, state, 0.0,
                         [&](std::string_view name, double ratio) {
                           double& most = worst[name];
                           most = std::max(most, ratio);
                         });
    }
    for (const auto& [name, ratio] : worst) {
      result.worst_ratio = std::max(result.worst_ratio, ratio);
      if (ratio <= 1 + kTolerated || !std::isfinite(ratio)) continue;
      const std::string_view limit = name == "deceleration" ? std::string_view("acceleration") : name;
      result.tighten.push_back({limit, from, from + ds, (1 - 5e-8) / ratio});
      if (ratio > 1 + kCoarse) result.cut[k] = true;
    }
    const double exact_J = segment_energy_J(motion, profile, k);
    error_J[k] = transcribed_energy_J(problem, profile, k) - exact_J;
    result.energy_J += exact_J;
  }
  double sum_J = 0, size_J = 0;
  for (double e : error_J) sum_J += e, size_J += std::abs(e);
  result.energy_error_J = std::abs(sum_J);
  const double total_J = std::max(std::abs(result.energy_J), 1e-9);
  if (result.energy_error_J > accuracy * total_J)
    for (std::size_t k = 0; k < count; ++k)
      if (std::abs(error_J[k]) > 0.2 * size_J / static_cast<double>(count)) result.cut[k] = true;
  return result;
}

}  // namespace joulepath::nlp
