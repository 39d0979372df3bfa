#pragma once

#include <optional>

#include "benchmarks/paper/protocol.hpp"
#include "model/plant.hpp"
#include "planner/path/geometry/bezier.hpp"

namespace joulepath::bench {

/// Use of negative power while braking: kept as V i, or lost at each wheel.
enum class NegativePower { lost, counted };

/// The path of the robot: a cubic Bezier, or straight on.
struct Track {
  std::optional<BezierSegment> curve{};
  double straight_m{};

  double length_m() const { return curve ? curve->length_m() : straight_m; }
};

/// The curve of [P1, Eq. (34)]; `bend` +1 to the left as printed, -1 mirrored.
[[nodiscard]] Track paper_curve(double bend);

/// One instant of a drive.
struct DriveSample {
  double time_s{};
  double speed_m_s{};
  Sided<double> power_W{};  ///< V i, negative where the drive returns power
};

/// The model's power along a track, at the middle of steps of `step_s` or a little less.
[[nodiscard]] std::vector<DriveSample> drive(const Plant& plant, double payload_kg, const Track& track,
                                             const SpeedProfile& profile, double step_s);

/// Energy of both wheels over the drive (midpoint rule, 2 ms).
[[nodiscard]] Sided<double> drive_energy_J(const Plant& plant, double payload_kg, const Track& track,
                                           const SpeedProfile& profile, NegativePower negative);

}  // namespace joulepath::bench
