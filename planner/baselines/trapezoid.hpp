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
  /// What a change of curvature may use of the yaw acceleration limit; the rest is kept to accelerate with.
  double curve_share{1.0};
};

/// Trapezoids over one request, clipped to the local speed limits (speed caps, lateral acceleration, yaw
/// rate; yaw acceleration, |turn' b| <= share of it), on a fixed grid. Accelerations are clipped to what the
/// yaw acceleration limit leaves: |turn a + turn' b| <= limit.
class TrapezoidFamily {
 public:
  explicit TrapezoidFamily(const ProfileRequest& request);

  /// Whether curvature changes anywhere: else the share makes no difference.
  bool curves() const;
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
  std::optional<double> rate_for(double acceleration, double deceleration, double curve_share,
                                 double duration_s) const;
  /// The least time that any profile needs on this grid; infinite where none passes.
  double least_duration_s() const;
  /// The executable profile, with nodes where acceleration, cruise and deceleration meet.
  Profile profile(const TrapezoidSettings& settings) const;
  std::map<std::string, double> parameters(const TrapezoidSettings& settings) const;

 private:
  /// What holds the rate back on a grid, for one share.
  struct Clip {
    std::vector<double> s{};
    std::vector<double> cap{};           ///< of b, per node
    std::vector<std::size_t> segment{};  ///< of the problem's grid, per segment of this one
  };
  Clip clip(double curve_share) const;
  /// Largest acceleration (deceleration) in a segment of the grid beside a node with the square b.
  double steepest(std::size_t segment, double ds, double b, bool accelerates) const;
  std::vector<double> squares_on(const Clip& clip, const TrapezoidSettings& settings) const;

  const ProfileRequest* request_{};
  nlp::Problem problem_{};
  double most_acceleration_{};
  double most_deceleration_{};
};

}  // namespace joulepath
