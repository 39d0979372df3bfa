#include "planner/motion/path_motion.hpp"

#include <algorithm>
#include <cmath>

#include "model/kinematics.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kMemoryCells = 2000;

}  // namespace

PathMotion::PathMotion(const PathPiece& piece, const Plant& plant, PayloadAlongPath payload,
                       double time_of_day_start_s, const EffectMemory& memory)
    : piece_(&piece),
      plant_(&plant),
      payload_(payload),
      time_of_day_start_s_(time_of_day_start_s),
      length_(piece_length(piece)) {
  if (remembers(plant)) tabulate_memory(memory);
}

double PathMotion::payload_kg(double s) const {
  if (length_ <= 0 || payload_.from_kg == payload_.to_kg) return payload_.from_kg;
  return payload_.from_kg + (payload_.to_kg - payload_.from_kg) * std::clamp(s / length_, 0.0, 1.0);
}

PathRates PathMotion::rates(double s) const {
  if (is_turn(*piece_)) return {0.0, static_cast<double>(turn_sign(*piece_)), 0.0};
  const PathBend bend = piece_bend(*piece_, s);
  return {static_cast<double>(travel_sign(*piece_)), bend.curvature_per_m, bend.curvature_slope_per_m2};
}

PathMotion::Place PathMotion::place(double s, double time_s) const {
  const PathPoint point = piece_point(*piece_, s);
  Place place;
  place.rates = is_turn(*piece_) ? PathRates{0.0, static_cast<double>(turn_sign(*piece_)), 0.0}
                                 : PathRates{static_cast<double>(travel_sign(*piece_)), point.curvature_per_m,
                                             point.curvature_slope_per_m2};
  place.site = site_of(plant_->robot.geometry, point.pose, payload_kg(s), place.rates.along, place.rates.turn,
                       time_of_day_start_s_ + time_s);
  if (!memory_.empty()) place.site.memory = memory(s);
  return place;
}

PathMotion::Place PathMotion::laws(double s, double time_s) const {
  if (!plant_->effects.empty()) return place(s, time_s);
  const PathRates here = rates(s);
  const Sided<double> wheels = wheel_speeds_rad_s(plant_->robot.geometry, here.along, here.turn);
  return {here,
          {.time_of_day_s = time_of_day_start_s_ + time_s,
           .payload_kg = payload_kg(s),
           .travel_direction = sign_of(here.along),
           .turn_direction = sign_of(here.turn),
           .wheel_direction = {sign_of(wheels.left), sign_of(wheels.right)}}};
}

Twist<double> PathMotion::twist(double s) const {
  const PathRates here = rates(s);
  return {here.along, here.turn};
}

EffectMemory PathMotion::memory(double s) const {
  if (memory_.empty()) return {};
  const double place = std::clamp(s, 0.0, length_);
  const auto cell = std::min(static_cast<std::size_t>(place / memory_step_), memory_.size() - 1);
  EffectMemory result = memory_[cell];
  advance_memory_along(
      *plant_, [&](double at) { return twist(at); }, static_cast<double>(cell) * memory_step_, place, 1,
      result);
  return result;
}

void PathMotion::tabulate_memory(const EffectMemory& start) {
  memory_step_ = length_ / static_cast<double>(kMemoryCells);
  if (!(memory_step_ > 0)) return;
  memory_.assign(1, start);
  for (std::size_t i = 0; i < kMemoryCells; ++i) {
    const double from = static_cast<double>(i) * memory_step_;
    memory_.push_back(memory_.back());
    advance_memory_along(
        *plant_, [&](double at) { return twist(at); }, from, from + memory_step_, 1, memory_.back());
  }
}

PathMotion path_motion(const ProfileRequest& request) {
  return PathMotion(request.piece, request.plant, request.payload, request.time_of_day_s, request.memory);
}

}  // namespace joulepath
