#include "diagnosis/calibration/identifiability.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "model/text_of_list.hpp"

namespace joulepath::calibration {
namespace {

constexpr double kLeastExcitation = 3;  ///< least ratio of acceleration to its noise, both squared
constexpr double kWidestDirection = 0.5, kWidestPayloadFactor = 0.05;

/// Indices of the free parameters.
std::vector<int> indices(const FreeParameters& free) {
  std::vector<int> list;
  for (int p = 0; p < kFitParameters; ++p)
    if (free[static_cast<std::size_t>(p)]) list.push_back(p);
  return list;
}

/// Information of the free parameters, each in units of its nominal value.
Eigen::MatrixXd scaled_information(const FitSums& sums, const FitWeights& weights, const FitValues& nominal,
                                   const std::vector<int>& free) {
  const auto all = information(sums, weights, nominal);
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd H(n, n);
  const auto scale = [&](Eigen::Index i) {
    const double value = nominal[static_cast<std::size_t>(free[static_cast<std::size_t>(i)])];
    return value > 0 ? value : 1.0;
  };
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      H(i, j) =
          all(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]) * scale(i) * scale(j);
  return H;
}

std::string others(const Eigen::VectorXd& direction, const std::vector<int>& free, Eigen::Index held) {
  std::string names;
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    if (i != held && std::abs(direction[i]) > 0.2)
      append_item(names, fit_parameter_name(free[static_cast<std::size_t>(i)]));
  return names;
}

}  // namespace

const char* fit_parameter_name(int parameter) {
  constexpr const char* kNames[] = {"friction_torque_left_Nm",   "friction_torque_right_Nm",
                                    "viscous_friction_Nm_s_rad", "straight_inertia_kg_m2",
                                    "turning_inertia_kg_m2",     "payload_factor",
                                    "torque_per_ampere_Nm_A",    "resistance_ohm"};
  return kNames[parameter];
}

namespace {

void hold(Identifiability& result, int parameter, std::string why) {
  result.free[static_cast<std::size_t>(parameter)] = false;
  result.why[static_cast<std::size_t>(parameter)] = std::move(why);
}

/// Parameters that no run excites.
Identifiability excited(const FitSums& sums) {
  Identifiability result;
  result.free.fill(true);
  if (sums.voltage_count == 0)
    for (int electrical : {kResistance, kTorquePerAmpere})
      hold(result, electrical, "no run has motor voltages");
  for (int inertia : {kStraightInertia, kTurningInertia})
    if (!(sums.torque(inertia, inertia) > kLeastExcitation * sums.acceleration_noise))
      hold(result, inertia,
           inertia == kStraightInertia ? "the runs hardly accelerate"
                                       : "the runs hardly change their yaw rate");
  return result;
}

}  // namespace

Identifiability identifiable(const FitSums& sums, const FitValues& nominal) {
  Identifiability result = excited(sums);
  while (true) {
    const std::vector<int> free = indices(result.free);
    if (free.empty()) return result;
    const FitWeights weights = fit_weights(sums, nominal, result.free);
    const Eigen::MatrixXd H = scaled_information(sums, weights, nominal, free);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(H);
    const double strongest = modes.eigenvalues().maxCoeff(), weakest = modes.eigenvalues()[0];
    const bool singular = !(weakest > 1e-12 * strongest);
    if (singular || 1 / std::sqrt(weakest) > kWidestDirection) {
      const Eigen::VectorXd direction = modes.eigenvectors().col(0);
      Eigen::Index held = 0;
      direction.cwiseAbs().maxCoeff(&held);
      const std::string with = others(direction, free, held);
      hold(result, free[static_cast<std::size_t>(held)],
           with.empty() ? "the runs hardly excite it" : "cannot be separated from " + with);
      continue;
    }
    if (result.free[kPayloadFactor]) {
      Eigen::Index at = 0;
      while (free[static_cast<std::size_t>(at)] != kPayloadFactor) ++at;
      if (std::sqrt(H.inverse()(at, at)) > kWidestPayloadFactor) {
        hold(result, kPayloadFactor, "the runs hardly show it");
        continue;
      }
    }
    return result;
  }
}

}  // namespace joulepath::calibration
