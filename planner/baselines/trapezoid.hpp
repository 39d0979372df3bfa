#pragma once

#include <optional>

#include "planner/baselines/baseline.hpp"
#include "planner/nlp/problem.hpp"

namespace joulepath {

/// Settings of a trapezoid: cruise rate, acceleration, deceleration of the path coordinate.
struct TrapezoidSettings {
  double rate{};
  double acceleration{};
  double deceleration{};
};

/// Trapezoids over one request, clipped to the local speed limits (speed caps, lateral acceleration, yaw
/// rate; yaw acceleration at constant speed), on a fixed grid.
class TrapezoidFamily {
 public:
  explicit TrapezoidFamily(const ProfileRequest& request);

  /// Largest accelerations that the limits name; kUnlimited where there is none.
  static constexpr double kUnlimited = 20.0;
  double most_acceleration() const { return most_acceleration_; }
  double most_deceleration() const { return most_deceleration_; }

  /// Squares of the rate at the grid's nodes; nothing where start or end speed cannot be kept.
  std::optional<std::vector<double>> squares(const TrapezoidSettings& settings) const;
  double duration_s(const std::vector<double>& b) const;
  /// Energy without standby by the transcription; infinite where a row is broken.
  double energy_J(const std::vector<double>& b) const;
  /// The cruise rate with which the whole takes `duration_s`; nothing where no rate is fast enough.
  std::optional<double> rate_for(double acceleration, double deceleration, double duration_s) const;
  /// The executable profile, with nodes where acceleration, cruise and deceleration meet.
  Profile profile(const TrapezoidSettings& settings) const;
  std::map<std::string, double> parameters(const TrapezoidSettings& settings) const;

 private:
  std::vector<double> squares_on(const std::vector<double>& s, const std::vector<double>& cap,
                                 const TrapezoidSettings& settings) const;

  const ProfileRequest* request_{};
  nlp::Problem problem_{};
  std::vector<double> cap_{};  ///< of b, per node
  double most_acceleration_{};
  double most_deceleration_{};
};

}  // namespace joulepath
