#include "diagnosis/checks/pose_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "diagnosis/checks/small_fit.hpp"
#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/median.hpp"
#include "model/plant.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

constexpr double kPiece_m = 0.3;           ///< well above the noise of a localization
constexpr double kPiece_rad = 0.2;         ///< the same
constexpr double kStraightest_rad = 0.15;  ///< arc and chord differ by less than 0.1 %
constexpr double kBentest_rad = 0.5;  ///< the same after the correction of a circle, by the measured heading
constexpr double kLeastTold = 0.03;   ///< creep that no fit separates from the radius is smaller
constexpr double kMostDissent = 1.0 / 3;  ///< of a deviation, between a part of the pieces and all
constexpr std::size_t kPiecesToDissent = 4;
constexpr double kUnit = 3.2;  ///< feet in a meter: factors beyond are of another unit

/// A way, or an angle of yaw, between two samples of a run.
struct Piece {
  /// By the wheels, and what may add to it: gained speed and acceleration (a lag, to the second order), and
  /// speed times its gain in a way, or the way in a turn.
  Eigen::Vector4d wheels{};
  double pose{};
  double time_s{};
  std::size_t run{};

  double rate() const { return wheels[0] / time_s; }
};
using Pieces = std::vector<Piece>;

using Rows = std::vector<std::size_t>;

/// Rows of a log in which one of the channels has a new value. The first row may repeat an earlier one.
Rows rows_of_readings(const std::vector<const std::vector<double>*>& channels) {
  Rows rows;
  for (std::size_t i = 1; i < channels.front()->size(); ++i)
    if (std::ranges::any_of(channels,
                            [&](const auto* channel) { return (*channel)[i] != (*channel)[i - 1]; }))
      rows.push_back(i);
  return rows;
}

/// Whether the log repeats the readings of a slower instrument for longer than the smoothing evens out.
bool are_held(const Rows& rows, const RunSignals& run) {
  Rows steps;
  for (std::size_t k = 1; k < rows.size(); ++k) steps.push_back(rows[k] - rows[k - 1]);
  if (steps.empty()) return false;
  const std::size_t median = upper_median(std::move(steps));
  return median > 1 && static_cast<double>(median) * run.log_period_s > kBlurredReadings * run.kernel_sigma_s;
}

/// The run at the rows of its pose's readings: the poses as logged, the wheels between the samples around.
RunSignals at_readings(const RunSignals& run, const Trajectory& log, Rows rows) {
  std::erase_if(rows, [&](std::size_t i) {
    return !(log.time_s[i] >= run.time_s[0] && log.time_s[i] <= run.time_s[run.size() - 1]);
  });
  const auto logged = [&](const std::vector<double>& channel) {
    Eigen::VectorXd at(channel.empty() ? 0 : std::ssize(rows));
    for (Eigen::Index k = 0; k < at.size(); ++k) at[k] = channel[rows[static_cast<std::size_t>(k)]];
    return at;
  };
  RunSignals result{.run_index = run.run_index, .heading_measured = run.heading_measured};
  result.time_s = logged(log.time_s);
  result.x_m = logged(log.position_x_m), result.y_m = logged(log.position_y_m);
  if (run.heading_measured) result.heading_rad = logged(unwrap_angle(log.heading_rad));
  const auto between = [&](const Eigen::VectorXd& samples) {
    Eigen::VectorXd at(result.size());
    for (Eigen::Index k = 0, j = 1; k < at.size(); ++k) {
      while (j + 1 < run.size() && run.time_s[j] < result.time_s[k]) ++j;
      const double share = (result.time_s[k] - run.time_s[j - 1]) / (run.time_s[j] - run.time_s[j - 1]);
      at[k] = samples[j - 1] + share * (samples[j] - samples[j - 1]);
    }
    return at;
  };
  for (const Side side : kSides) {
    result.wheel_angle_rad[side] = between(run.wheel_angle_rad[side]);
    result.wheel_speed_rad_s[side] = between(run.wheel_speed_rad_s[side]);
    result.wheel_acceleration_rad_s2[side] = between(run.wheel_acceleration_rad_s2[side]);
  }
  return result;
}

/// Ways (m) and yaw angles (rad) of one run, by wheels and pose.
class PieceReader {
 public:
  /// `held`: samples of a pose slower than the log, too far apart for straight pieces alone.
  PieceReader(const RunSignals& run, const Geometry& geometry, bool held)
      : run_(run), geometry_(geometry), held_(held) {}

  void read_ways(Pieces& ways) const {
    if (run_.x_m.size() == run_.size() && run_.y_m.size() == run_.size())
      walk(&Twist<double>::speed_m_s, kPiece_m, ways);
  }
  void read_turns(Pieces& turns) const {
    if (run_.heading_measured) walk(&Twist<double>::yaw_rate_rad_s, kPiece_rad, turns);
  }

 private:
  Twist<double> change(const Sided<Eigen::VectorXd>& of, Eigen::Index from, Eigen::Index to) const {
    return body_twist<double>(geometry_, {of.left[to] - of.left[from], of.right[to] - of.right[from]});
  }

  void walk(double Twist<double>::*along, double length, Pieces& pieces) const {
    const bool is_way = along == &Twist<double>::speed_m_s;
    for (Eigen::Index from = 0, to = 1; to < run_.size(); ++to) {
      const Twist<double> moved = change(run_.wheel_angle_rad, from, to);
      const bool turned_back = change(run_.wheel_angle_rad, to - 1, to).*along * (moved.*along) <= 0;
      if (turned_back || (is_way && is_bent(from, to, moved))) from = to;
      if (from == to || std::abs(moved.*along) < length) continue;
      add(is_way, from, to, moved, pieces);
      from = to;
    }
  }

  bool bends_by_heading() const { return held_ && run_.heading_measured; }

  bool is_bent(Eigen::Index from, Eigen::Index to, const Twist<double>& moved) const {
    return bends_by_heading() ? !(std::abs(run_.heading_rad[to] - run_.heading_rad[from]) <= kBentest_rad)
                              : std::abs(moved.yaw_rate_rad_s) > kStraightest_rad;
  }

  /// Of the circle with the measured change of heading; of a straight line where none bends it.
  double arc_over_chord(Eigen::Index from, Eigen::Index to) const {
    const double half_rad = bends_by_heading() ? 0.5 * (run_.heading_rad[to] - run_.heading_rad[from]) : 0.0;
    return std::abs(half_rad) < 1e-6 ? 1.0 : half_rad / std::sin(half_rad);
  }

  void add(bool is_way, Eigen::Index from, Eigen::Index to, const Twist<double>& moved,
           Pieces& pieces) const {
    const Twist<double> gained = change(run_.wheel_speed_rad_s, from, to),
                        pushed = change(run_.wheel_acceleration_rad_s2, from, to);
    const double time_s = run_.time_s[to] - run_.time_s[from], way = moved.speed_m_s,
                 turn = moved.yaw_rate_rad_s, sign = sign_of(is_way ? way : turn);
    const Piece piece =
        is_way ? Piece{{sign * way, sign * gained.speed_m_s, sign * pushed.speed_m_s,
                        sign * gained.speed_m_s * way / time_s},
                       arc_over_chord(from, to) *
                           std::hypot(run_.x_m[to] - run_.x_m[from], run_.y_m[to] - run_.y_m[from]),
                       time_s,
                       run_.run_index}
               : Piece{{sign * turn, sign * gained.yaw_rate_rad_s, sign * pushed.yaw_rate_rad_s, sign * way},
                       sign * (run_.heading_rad[to] - run_.heading_rad[from]),
                       time_s,
                       run_.run_index};
    if (std::isfinite(piece.pose)) pieces.push_back(piece);
  }

  const RunSignals& run_;
  const Geometry& geometry_;
  bool held_{};
};

/// Reads one run, at the readings of its position and of its heading where the log holds them.
void read_run(const RunSignals& run, const Trajectory& log, const Geometry& geometry, Pieces& ways,
              Pieces& turns) {
  const auto read = [&](const Rows& rows, auto reading, Pieces& pieces) {
    const bool held = run.size() > 1 && are_held(rows, run);
    if (held)
      (PieceReader(at_readings(run, log, rows), geometry, true).*reading)(pieces);
    else
      (PieceReader(run, geometry, false).*reading)(pieces);
  };
  if (!log.position_x_m.empty() && !log.position_y_m.empty())
    read(rows_of_readings({&log.position_x_m, &log.position_y_m}), &PieceReader::read_ways, ways);
  if (run.heading_measured) read(rows_of_readings({&log.heading_rad}), &PieceReader::read_turns, turns);
}

/// The pose's way over the wheels', of like pieces.
struct Factor {
  double value{1.0}, error{};
  double dissent{};  ///< of a part of the pieces, the greatest

  bool is_surely_beyond(double share) const {
    const double deviation = std::abs(value - 1);
    return deviation - kSureSigmas * error > share && dissent < kMostDissent * deviation && value < kUnit &&
           value > 1 / kUnit;
  }

  Factor over(const Factor& other) const {
    const double ratio = value / other.value;
    return {ratio, std::abs(ratio) * std::hypot(error / value, other.error / other.value),
            std::abs(ratio) * (dissent / std::abs(value) + other.dissent / std::abs(other.value))};
  }
};

/// How far the pieces of one run, or those of slow or of fast motion, are from the factor of all.
double dissent_of(const Pieces& pieces, const std::array<double, 4>& fit) {
  std::vector<double> rates;
  for (const Piece& piece : pieces) rates.push_back(piece.rate());
  const double median = upper_median(std::move(rates));
  struct Part {
    double wheels{}, pose{};
    std::size_t count{};
  };
  std::map<std::pair<bool, std::size_t>, Part> parts;  // by run, and by speed
  for (const Piece& piece : pieces) {
    double added = 0;
    for (int k = 1; k < 4; ++k) added += fit[static_cast<std::size_t>(k)] * piece.wheels[k];
    const std::size_t is_fast = piece.rate() > median ? 1 : 0;
    for (Part* part : {&parts[{true, piece.run}], &parts[{false, is_fast}]})
      part->wheels += piece.wheels[0], part->pose += piece.pose - added, ++part->count;
  }
  double most = 0;
  for (const auto& entry : parts)
    if (const Part& part = entry.second; part.count >= kPiecesToDissent)
      most = std::max(most, std::abs(part.pose / part.wheels - fit[0]));
  return most;
}

/// None where the pieces determine none.
std::optional<Factor> factor_of(const Pieces& pieces) {
  SmallFit<4> fit;
  for (const Piece& piece : pieces) fit.add(piece.wheels, piece.pose);
  std::array<double, 4> value{}, error{};
  if (!fit.solve(value, error)) return {};
  return Factor{value[0], error[0], dissent_of(pieces, value)};
}

double told_beyond(const Robot& robot, const char* key) {
  const auto stated = robot.uncertainty.find(key);
  return std::max(kLeastTold, stated == robot.uncertainty.end() ? 0.0 : 3 * stated->second);
}

}  // namespace

PoseGeometry geometry_by_pose(const Dataset& dataset, const std::vector<RunSignals>& runs) {
  const Geometry geometry = make_plant(dataset.robot).robot.geometry;
  Pieces ways, turns;
  for (const RunSignals& run : runs)
    if (!dataset.runs[run.run_index].wheels_from_body_speeds)
      read_run(run, dataset.runs[run.run_index].log, geometry, ways, turns);
  PoseGeometry told;
  const std::optional<Factor> way = factor_of(ways), turn = factor_of(turns);
  if (way && way->is_surely_beyond(told_beyond(dataset.robot, "wheel_radius_m"))) told.radius = way->value;
  if (way && turn) {
    const Factor track = way->over(*turn);
    if (track.is_surely_beyond(told_beyond(dataset.robot, "half_track_m")))
      told.half_track = told.radius / turn->value, told.turning = turn->value;
  }
  return told;
}

Robot with_geometry(Robot robot, const PoseGeometry& geometry) {
  for (const Side side : kSides) robot.geometry.wheel_radius_m[side] *= geometry.radius;
  robot.geometry.half_track_m *= geometry.half_track;
  return robot;
}

std::vector<std::string> geometry_notes(const Robot& robot, const PoseGeometry& geometry) {
  std::vector<std::string> notes;
  const auto ask = [&](const std::string& pose, double share, const std::string& key, double file,
                       double factor) {
    if (factor != 1)
      notes.push_back("the pose " + pose + ' ' + four_digits(share) + " of what the wheels tell: " + key +
                      ' ' + four_digits(file) + " -> " + four_digits(file * factor) + '?');
  };
  ask("moves", geometry.radius, "wheel_radius_m", robot.geometry.wheel_radius_m.left, geometry.radius);
  ask("turns", geometry.turning, "half_track_m", robot.geometry.half_track_m, geometry.half_track);
  return notes;
}

std::vector<ForeignConstant> foreign_geometry(const Robot& robot, const PoseGeometry& geometry) {
  std::vector<ForeignConstant> foreign;
  const auto add = [&](const char* name, double file, double factor) {
    if (factor > kMostScale || factor < 1 / kMostScale) foreign.push_back({name, "m", file, file * factor});
  };
  add("wheel radius", robot.geometry.wheel_radius_m.left, geometry.radius);
  add("half track", robot.geometry.half_track_m, geometry.half_track);
  return foreign;
}

}  // namespace joulepath
