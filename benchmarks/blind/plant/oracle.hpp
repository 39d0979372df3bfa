#pragma once

#include <map>
#include <optional>
#include <string>

#include "observer.hpp"

namespace blind {

struct Case;

/// What an effect changes on the whole day.
struct Change {
  double battery_percent{};  ///< of the energy of the battery
  double effect_percent{};   ///< of the energy of the motors or of the battery, the larger one
  double pose_rms{};         ///< of the pose (m and rad together)
};

/// The best possible diagnosis with everything known except the calibration error, computed before any
/// diagnosis.
struct OracleResult {
  /// Expected 2 ln(likelihood ratio) of the true effects at their true size against none. Calibration errors
  /// are profiled with their prior, scatter between runs is marginalized, and the noise covariance is the
  /// true one.
  double likelihood_ratio{};
  /// The same for each effect alone, the others profiled: pairs, one figure per effect.
  std::map<std::string, double> each{};
  /// Share of the summed absolute power gap to the nominal model, by axis and cell.
  std::map<std::string, std::map<std::string, double>> where{};
  Change change{};  ///< by all effects together
  /// By each effect of several, the others being there.
  std::map<std::string, Change> each_change{};
  /// Of a single detectable effect of the catalog, if asked.
  std::optional<Separation> separation{};
  double energy_gap_percent{};  ///< sum over runs |nominal - true| energy / true energy
};

inline constexpr double kDetectable = 25.0;

[[nodiscard]] OracleResult consult_oracle(const Case& c, bool with_observer);
/// `{likelihood_ratio: ..., detectable: ..., each: {...}, where: {...}}` as JSON (which is YAML, too).
[[nodiscard]] std::string oracle_json(const OracleResult& result);

}  // namespace blind
