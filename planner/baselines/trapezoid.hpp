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
  /// What a change of curvature may use of the yaw acceleration limit; the rest is kept to accelerate with.
  double curve_share{1.0};
};

/// Largest accelerations of the path coordinate that the limits name; kUnlimited where there is none.
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
  /// Squares of the rate at the grid's nodes; nothing where start or end speed cannot be kept.
  std::optional<std::vector<double>> squares(const TrapezoidSettings& settings) const;
  double duration_s(const std::vector<double>& b) const;
  /// Energy without standby by the transcription; infinite where a row is broken.
  double energy_J(const std::vector<double>& b) const;
  /// The cruise rate with which the whole takes `duration_s`; nothing where no rate is fast enough.
  std::optional<double> rate_for(double acceleration, double deceleration, double curve_share,
                                 double duration_s) const;
  /// The least time that any profile needs on this grid; infinite where none passes.
  double least_duration_s() const;
  /// The executable profile, with nodes where acceleration, cruise and deceleration meet.
  Profile profile(const TrapezoidSettings& settings) const;
  std::map<std::string, double> parameters(const TrapezoidSettings& settings) const;

 private:
  std::vector<double> squares_on(const LocalLimits::Grid& grid, const TrapezoidSettings& settings) const;

  const ProfileRequest* request_{};
  LocalLimits local_;
};

}  // namespace joulepath
