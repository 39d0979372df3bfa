#pragma once

#include <optional>

#include "planner/baselines/baseline.hpp"
#include "planner/baselines/local_limits.hpp"

namespace joulepath {

/// Settings of a trapezoid: cruise rate, acceleration, deceleration of the path coordinate.
struct TrapezoidSettings {
  double rate{};
  double acceleration{};
  double deceleration{};
  /// The share of the yaw acceleration limit for changes of curvature; the rest is for the acceleration.
  double curve_share{1.0};
};

/// Largest accelerations of the path coordinate by the limits; kUnlimited if there is none.
inline constexpr double kUnlimited = 20.0;
[[nodiscard]] double most_acceleration(const ProfileRequest& request);
[[nodiscard]] double most_deceleration(const ProfileRequest& request);

/// Trapezoids over one request on a fixed grid, clipped to its local limits.
class TrapezoidFamily {
 public:
  explicit TrapezoidFamily(const ProfileRequest& request);

  static constexpr double kUnlimited = joulepath::kUnlimited;
  double most_acceleration() const { return joulepath::most_acceleration(*request_); }
  double most_deceleration() const { return joulepath::most_deceleration(*request_); }
  const LocalLimits& local() const { return local_; }
  bool curves() const { return local_.curves(); }
  /// Squares of the rate at the grid's nodes; nothing if start or end speed cannot be kept.
  std::optional<std::vector<double>> squares(const TrapezoidSettings& settings) const;
  double duration_s(const std::vector<double>& b) const;
  /// Energy without standby by the transcription; infinite if a row is violated.
  double energy_J(const std::vector<double>& b) const;
  /// The cruise rate for which the whole takes `duration_s`, to `tolerance` of it; nothing if no rate is fast
  /// enough.
  std::optional<double> rate_for(double acceleration, double deceleration, double curve_share,
                                 double duration_s, double tolerance = 1e-13) const;
  /// The least time of any profile on this grid; infinite if there is no profile.
  double least_duration_s() const;
  /// The executable profile, with nodes where acceleration, cruise and deceleration meet.
  Profile profile(const TrapezoidSettings& settings) const;
  std::map<std::string, double> parameters(const TrapezoidSettings& settings) const;

 private:
  const LocalLimits::Grid& grid(double curve_share) const;
  std::vector<double> squares_on(const LocalLimits::Grid& grid, const TrapezoidSettings& settings) const;

  const ProfileRequest* request_{};
  LocalLimits local_;
  /// Of the last curve share: a search has one.
  mutable double grid_share_{-1};
  mutable LocalLimits::Grid grid_{};
};

}  // namespace joulepath
