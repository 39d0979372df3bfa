#include "extensions/onboard/replan/place_table.hpp"

#include <algorithm>
#include <cmath>

#include "planner/nlp/transcription/affine_fit.hpp"
#include "planner/nlp/transcription/grid.hpp"

namespace joulepath {
namespace {

using nlp::Affine;
using nlp::AffineWheel;
using nlp::RateCap;
using nlp::Segment;
using nlp::SegmentPoint;

constexpr double kStep_kg = 8.0;        ///< of the load, to read off what a kilogram changes
constexpr double kAffineInLoad = 1e-9;  ///< relative: what counts as rounding

/// Calls use(place, index) for the places of a segment, those of limits first.
template <class AnySegment, class Use>
void for_each_place(AnySegment& segment, Use&& use) {
  std::size_t index = 0;
  for (auto& point : segment.limit_points) use(point, index++);
  for (auto& point : segment.energy_points) use(point, index++);
}

Affine combined(const Affine& x, double factor, const Affine& y) {
  return {x.constant + factor * y.constant, x.of_a + factor * y.of_a, x.of_b + factor * y.of_b,
          x.of_u + factor * y.of_u};
}

AffineWheel combined(const AffineWheel& x, double factor, const AffineWheel& y) {
  return {combined(x.current_A, factor, y.current_A), combined(x.voltage_V, factor, y.voltage_V),
          combined(x.force_N, factor, y.force_N)};
}

double size(const Affine& x) {
  return std::abs(x.constant) + std::abs(x.of_a) + std::abs(x.of_b) + std::abs(x.of_u);
}

bool same(const AffineWheel& x, const AffineWheel& y) {
  const AffineWheel difference = combined(x, -1, y);
  return size(difference.current_A) <= kAffineInLoad * (1 + size(x.current_A)) &&
         size(difference.voltage_V) <= kAffineInLoad * (1 + size(x.voltage_V)) &&
         size(difference.force_N) <= kAffineInLoad * (1 + size(x.force_N));
}

/// The wheels' laws at a place with more on board; false where they are not affine.
bool laws_at(const Plant& plant, const SegmentPoint& point, double extra_kg, Sided<AffineWheel>& wheel) {
  Site site = point.site;
  site.payload_kg += extra_kg;
  return nlp::AffineFit(plant).at(point.rates, site, wheel);
}

}  // namespace

PlaceTable::PlaceTable(const ProfileRequest& request, const PathMotion& motion, const Profile& plan,
                       std::size_t nodes)
    : request_(request), motion_(motion), s_(nlp::make_grid(motion, request, nodes)) {
  for (std::size_t k = 0; k + 1 < s_.size(); ++k) {
    segments_.push_back(nlp::make_segment(request, motion, s_[k], s_[k + 1], &plan));
    longest_ = std::max(longest_, segments_.back().ds);
  }
  tabulate_loads();
  update_caps();
}

/// What a kilogram changes; a place whose laws are not affine in the load is evaluated through the model.
void PlaceTable::tabulate_loads() {
  per_kg_.resize(segments_.size());
  for (std::size_t k = 0; k < segments_.size(); ++k)
    for_each_place(segments_[k], [&](SegmentPoint& point, std::size_t index) {
      if (!point.affine) return;
      Sided<AffineWheel> half, whole;
      point.affine = laws_at(request_.plant, point, 0.5 * kStep_kg, half) &&
                     laws_at(request_.plant, point, kStep_kg, whole);
      for (const Side side : kSides) {
        AffineWheel change = combined(whole[side], -1, point.wheel[side]);
        const AffineWheel none{};
        AffineWheel& per_kg = per_kg_[k][index][side];
        per_kg = combined(none, 1 / kStep_kg, change);
        point.affine = point.affine && same(half[side], combined(point.wheel[side], 0.5, change));
      }
    });
}

void PlaceTable::update_caps() {
  const Limits& limits = request_.limits;
  const std::array now{limits.speed_m_s, limits.reverse_speed_m_s, limits.yaw_rate_rad_s,
                       limits.lateral_acceleration_m_s2};
  if (!caps_.empty() && now == caps_for_) return;
  caps_for_ = now;
  caps_.assign(s_.size(), {});
  for (std::size_t k = 0; k + 1 < s_.size(); ++k)
    nlp::lower_caps(request_, motion_, segments_[k], no_tightenings_, caps_[k], caps_[k + 1]);
}

void PlaceTable::copy_segment(std::size_t k, double extra_kg, Segment& to) const {
  to = segments_[k];
  if (extra_kg == 0) return;
  for_each_place(to, [&](SegmentPoint& point, std::size_t index) {
    point.site.payload_kg += extra_kg;
    if (!point.affine) return;
    for (const Side side : kSides)
      point.wheel[side] = combined(point.wheel[side], extra_kg, per_kg_[k][index][side]);
  });
}

Segment PlaceTable::part(double from, double to, double extra_kg) const {
  Segment segment = nlp::make_segment(request_, motion_, from, to, nullptr);
  if (extra_kg != 0)
    for_each_place(segment, [&](SegmentPoint& point, std::size_t) {
      point.affine = laws_at(request_.plant, point, extra_kg, point.wheel);
      point.site.payload_kg += extra_kg;
    });
  return segment;
}

RateCap PlaceTable::cap(std::size_t k, double s) const {
  const RateCap &from = caps_[k], &to = caps_[k + 1];
  const double share = (s - s_[k]) / (s_[k + 1] - s_[k]);
  if (share <= 0) return from;
  if (share >= 1) return to;
  RateCap cap = from.squared < to.squared ? from : to;
  // The chord of the ends is below the cap inside.
  if (std::isfinite(from.squared) && std::isfinite(to.squared))
    cap.squared = (1 - share) * from.squared + share * to.squared;
  return cap;
}

}  // namespace joulepath
