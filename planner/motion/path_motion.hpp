#pragma once

#include <vector>

#include "model/kinematics.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// How the body moves per unit of the path coordinate s, whose rate is u = ds/dt >= 0:
///   v = along u,   omega = turn u,   omega' = turn a + turn_slope u^2,   a = du/dt.
/// A curve has along = +/-1 and turn = kappa; a turn in place has along = 0 and turn = +/-1.
struct PathRates {
  double along{};
  double turn{};
  double turn_slope{};
};

/// A piece of path driven by a plant: all quantities that depend on the place alone. It keeps references to
/// the piece and the plant, which must outlive it.
class PathMotion {
 public:
  PathMotion(const PathPiece& piece, const Plant& plant, PayloadAlongPath payload,
             double time_of_day_start_s = 0.0, const EffectMemory& memory = {});

  double length() const { return length_; }
  const PathPiece& piece() const { return *piece_; }
  const Plant& plant() const { return *plant_; }
  double time_of_day_start_s() const { return time_of_day_start_s_; }
  double payload_kg(double s) const;

  PathRates rates(double s) const;
  /// Rates and site at s; directions are those of the path's tangent, so they are defined at rest too.
  struct Place {
    PathRates rates{};
    Site site{};
  };
  Place place(double s, double time_s) const;
  /// The same, in less time: without pose and course where no effect reads them.
  Place laws(double s, double time_s) const;
  Site site(double s, double time_s) const { return place(s, time_s).site; }
  /// Memories of the casters at s.
  EffectMemory memory(double s) const;

  /// Body motion at rate u with acceleration a of the path coordinate.
  template <class Real>
  static BodyMotion<Real> body_motion(const PathRates& rates, const Real& u, const Real& a) {
    return {Real(rates.along * u), Real(rates.along * a), Real(rates.turn * u),
            Real(rates.turn * a + rates.turn_slope * (u * u))};
  }

 private:
  /// Twist of the body per unit of the path coordinate.
  Twist<double> twist(double s) const;
  void tabulate_memory(const EffectMemory& start);

  const PathPiece* piece_{};
  const Plant* plant_{};
  PayloadAlongPath payload_{};
  double time_of_day_start_s_{};
  double length_{};
  double memory_step_{};
  std::vector<EffectMemory> memory_{};  ///< every memory_step_; empty without such effects
};

/// The motion that a request's profile is evaluated with; the request must outlive it.
[[nodiscard]] PathMotion path_motion(const ProfileRequest& request);

}  // namespace joulepath
