#pragma once

#include <array>
#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath {

/// A piece of path on a fixed grid with all that a transcription needs at its places, for any payload: wheel
/// laws are affine in the load on board. Made once; what is asked of it later allocates nothing.
class PlaceTable {
 public:
  /// `plan` tells when the robot is where. Refers to the request and the motion.
  PlaceTable(const ProfileRequest& request, const PathMotion& motion, const Profile& plan, std::size_t nodes);

  const std::vector<double>& s() const { return s_; }
  std::size_t segment_count() const { return segments_.size(); }
  double longest() const { return longest_; }  ///< segment

  /// A whole segment with `extra_kg` more on board than planned.
  void copy_segment(std::size_t k, double extra_kg, nlp::Segment& to) const;
  /// A part of a segment, from the model.
  [[nodiscard]] nlp::Segment part(double from, double to, double extra_kg) const;

  /// Reads the request's limits on the rate again, where they differ from those of the last time.
  void update_caps();
  /// Largest square of the rate at a place in segment k.
  [[nodiscard]] nlp::RateCap cap(std::size_t k, double s) const;

 private:
  static constexpr std::size_t kPlaces = nlp::kLimitPoints + nlp::kEnergyPoints;
  using Laws = std::array<Sided<nlp::AffineWheel>, kPlaces>;
  void tabulate_loads();

  const ProfileRequest& request_;
  const PathMotion& motion_;
  std::vector<double> s_{};
  std::vector<nlp::Segment> segments_{};
  std::vector<Laws> per_kg_{};
  std::vector<nlp::RateCap> caps_{};  ///< at the nodes
  std::array<double, 4> caps_for_{};  ///< speed, reverse speed, yaw rate, lateral acceleration
  std::vector<nlp::Tightening> no_tightenings_{};
  double longest_{};
};

}  // namespace joulepath
