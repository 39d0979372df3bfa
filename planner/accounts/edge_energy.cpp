#include "planner/accounts/edge_energy.hpp"

#include <algorithm>

#include "planner/legs/prescribed_leg.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/values/leg_state.hpp"

namespace joulepath {
namespace {

using Kind = EdgeEnergy::Kind;

class Rows {
 public:
  Rows(const Plant& plant, std::vector<EdgeEnergy>& rows) : plant_(plant), rows_(rows) {}

  void leg(const LegPlan& leg, std::size_t index) {
    index_ = index;
    now_s_ = leg.start_s;
    place_ = leg.start_pose;
    if (leg.prescribed) prescribed(leg);
    double from_m = 0;
    for (const StretchPlan& stretch : leg.stretches) {
      is_turn(stretch.request.piece) ? turn(stretch) : drive(leg, stretch, from_m);
      const double wait_s = stretch.profile.wait_s;
      if (wait_s > 0) rest(Kind::wait, wait_s, place_, stretch.request.payload.to_kg);
      if (!is_turn(stretch.request.piece)) from_m += piece_length(stretch.request.piece);
    }
    if (leg.dwell_s > 0) rest(Kind::dwell, leg.dwell_s, place_, leg.payload.to_kg);
  }

 private:
  void add(EdgeEnergy row) {
    row.leg = index_;
    row.start_s = now_s_;
    now_s_ += row.duration_s;
    place_ = row.to;
    rows_.push_back(std::move(row));
  }

  void rest(Kind kind, double duration_s, const Pose& place, double payload_kg) {
    EdgeEnergy row{
        .kind = kind, .duration_s = duration_s, .payload_kg = payload_kg, .from = place, .to = place};
    row.energy.standby_J = duration_s * plant_.robot.power.standby_W;
    add(std::move(row));
  }

  void prescribed(const LegPlan& leg) {
    const Trajectory& motion = *leg.prescribed;
    if (motion.size() == 0) return;
    add({.kind = Kind::prescribed,
         .duration_s = leg.duration_s,
         .distance_m = leg.distance_m,
         .payload_kg = leg.payload.from_kg,
         .from = sampled_state(motion, motion.time_s.front()).pose,
         .to = end_pose(motion),
         .energy = prescribed_energy(leg, plant_in(plant_, leg.state))});
  }

  /// The row of a part of a stretch between two path coordinates.
  EdgeEnergy between(const StretchPlan& stretch, double from, double to) const {
    const PathMotion motion = path_motion(stretch.request);
    const Profile& profile = stretch.profile;
    const double begin_s = from <= 0 ? 0.0 : profile.at_s(from).time_s;
    const double end_s = to >= motion.length() ? profile.time_s.back() : profile.at_s(to).time_s;
    return {.duration_s = end_s - begin_s,
            .payload_kg = motion.payload_kg(from),
            .from = piece_point(stretch.request.piece, from).pose,
            .to = piece_point(stretch.request.piece, to).pose,
            .energy = energy_between(motion, profile, begin_s, end_s)};
  }

  void turn(const StretchPlan& stretch) {
    const double angle_rad = piece_length(stretch.request.piece);
    EdgeEnergy row = between(stretch, 0, angle_rad);
    row.kind = Kind::turn;
    row.turned_rad = turn_sign(stretch.request.piece) * angle_rad;
    add(std::move(row));
  }

  void drive(const LegPlan& leg, const StretchPlan& stretch, double from_m) {
    const double length_m = piece_length(stretch.request.piece);
    std::vector<PathPart> parts = leg.parts;
    if (parts.empty()) parts.push_back({"", from_m, from_m + length_m});
    for (const PathPart& part : parts) {
      const double begin_m = std::max(0.0, part.from_m - from_m);
      const double end_m = std::min(length_m, part.to_m - from_m);
      if (!(end_m > begin_m + 1e-9)) continue;
      EdgeEnergy row = between(stretch, begin_m, end_m);
      row.name = part.name;
      row.distance_m = end_m - begin_m;
      add(std::move(row));
    }
  }

  const Plant& plant_;
  std::vector<EdgeEnergy>& rows_;
  std::size_t index_{};
  double now_s_{};
  Pose place_{};
};

}  // namespace

const char* edge_kind_name(EdgeEnergy::Kind kind) {
  switch (kind) {
    case Kind::turn:
      return "turn";
    case Kind::wait:
      return "wait";
    case Kind::dwell:
      return "dwell";
    case Kind::prescribed:
      return "prescribed";
    case Kind::drive:
      break;
  }
  return "drive";
}

std::vector<EdgeEnergy> edge_energies(const Plan& plan, const Plant& plant) {
  std::vector<EdgeEnergy> edges;
  Rows rows(plant, edges);
  for (std::size_t k = 0; k < plan.legs.size(); ++k) rows.leg(plan.legs[k], k);
  return edges;
}

}  // namespace joulepath
