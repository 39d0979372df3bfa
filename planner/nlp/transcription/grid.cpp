#include "planner/nlp/transcription/grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/operating_point.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/rate_cap.hpp"

namespace joulepath::nlp {
namespace {

constexpr std::size_t kScan = 1000;

constexpr int kLooksPerSegment = 24;
/// Share of the curvature at which a wheel stands; used where the curvature is only sampled or bounded.
constexpr double kSafeShare = 0.7;

/// Whether a wheel may stand or run backwards somewhere on a segment: |curvature| >= 1 / half track.
bool wheel_may_reverse(const CurveSegment& segment, double half_track_m) {
  return std::visit(
      [&](const auto& part) {
        // The curvature of the others is monotone: it is largest at an end.
        constexpr bool linear = !std::is_same_v<std::decay_t<decltype(part)>, BezierSegment>;
        if constexpr (!linear)
          if (part.curvature_bound_per_m() * half_track_m <= kSafeShare) return false;
        const int looks = linear ? 1 : kLooksPerSegment;
        double most_per_m = 0;
        for (int i = 0; i <= looks; ++i)
          most_per_m = std::max(most_per_m, std::abs(part.bend(part.length_m() * i / looks).curvature_per_m));
        return most_per_m * half_track_m > (linear ? 1 - 1e-9 : kSafeShare);
      },
      segment);
}

/// Torques of the wheels at negligible speed. Without effects they depend on the wheels' directions alone and
/// are computed only where a direction changes, which is looked for where a wheel may reverse.
class RestTorque {
 public:
  explicit RestTorque(const PathMotion& motion) : motion_(motion) {
    curve_ = motion.plant().effects.empty() ? std::get_if<Curve>(&motion.piece()) : nullptr;
    if (!curve_) return;
    for (const CurveSegment& segment : curve_->segments())
      reverses_.push_back(wheel_may_reverse(segment, motion.plant().robot.geometry.half_track_m));
  }

  const PathMotion& motion() const { return motion_; }
  Sided<double> at_Nm(double s) {
    if (curve_) {
      const std::size_t segment = curve_->segment_at(s);
      if (direction_ && segment == segment_ && !reverses_[segment]) return torque_Nm_;
      segment_ = segment;
    }
    const PathMotion::Place place = motion_.laws(s, 0.0);
    const bool known = motion_.plant().effects.empty() && direction_ == place.site.wheel_direction;
    if (!known) {
      const auto wheels = operating_point(motion_.plant(),
                                          PathMotion::body_motion<double>(place.rates, 0.0, 0.0), place.site);
      torque_Nm_ = {wheels.left.torque_Nm, wheels.right.torque_Nm};
      direction_ = place.site.wheel_direction;
    }
    return torque_Nm_;
  }

 private:
  const PathMotion& motion_;
  const Curve* curve_{};          ///< null with effects and for turns
  std::vector<bool> reverses_{};  ///< by segment: a wheel may reverse there
  std::size_t segment_{};         ///< of the last torque, as its direction
  std::optional<Sided<double>> direction_{};
  Sided<double> torque_Nm_{};
};

double difference(const Sided<double>& x, const Sided<double>& y) {
  return std::max(std::abs(x.left - y.left), std::abs(x.right - y.right));
}

/// Halves [low, high] towards the larger change; a jump keeps its size, a slope does not.
void find_jump(RestTorque& torque, double low, double high, const Sided<double>& at_low,
               const Sided<double>& at_high, std::vector<double>& nodes) {
  const double whole = difference(at_low, at_high);
  Sided<double> left = at_low, right = at_high;
  while (high - low > 1e-10 * torque.motion().length()) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    const Sided<double> inside = torque.at_Nm(middle);
    if (difference(left, inside) >= difference(inside, right)) {
      high = middle;
      right = inside;
    } else {
      low = middle;
      left = inside;
    }
    if (difference(left, right) < 0.2 * whole) return;
  }
  nodes.push_back(0.5 * (low + high));
}

void add_jumps(const PathMotion& motion, std::vector<double>& nodes) {
  const double length = motion.length();
  RestTorque torque(motion);
  Sided<double> before = torque.at_Nm(1e-9 * length);
  double scale = std::max({1e-9, std::abs(before.left), std::abs(before.right)});
  for (std::size_t i = 1; i <= kScan; ++i) {
    const double from = length * static_cast<double>(i - 1) / kScan,
                 to = length * static_cast<double>(i) / kScan;
    const Sided<double> here = torque.at_Nm(i == kScan ? length * (1 - 1e-9) : to);
    scale = std::max({scale, std::abs(here.left), std::abs(here.right)});
    if (difference(before, here) > 1e-3 * scale) find_jump(torque, from, to, before, here, nodes);
    before = here;
  }
}

bool torque_is_the_same_everywhere(const ProfileRequest& request) {
  if (is_turn(request.piece)) return request.plant.effects.empty();
  if (!request.plant.effects.empty()) return false;
  const Curve& curve = std::get<Curve>(request.piece);
  return std::all_of(curve.segments().begin(), curve.segments().end(), [](const CurveSegment& segment) {
    const auto* line = std::get_if<LinearCurvature>(&segment);
    return line && line->curvature_per_m() == 0 && line->curvature_slope_per_m2() == 0;
  });
}

/// Without effects only the sign of a wheel's friction jumps.
bool torque_may_jump(const ProfileRequest& request) {
  if (torque_is_the_same_everywhere(request)) return false;
  if (!request.plant.effects.empty()) return true;
  const std::vector<CurveSegment>& segments = std::get<Curve>(request.piece).segments();
  return std::any_of(segments.begin(), segments.end(), [&](const CurveSegment& segment) {
    return wheel_may_reverse(segment, request.plant.robot.geometry.half_track_m);
  });
}

/// Drops nodes that are closer together than rounding allows; both ends stay.
std::vector<double> without_doubles(std::vector<double> nodes, double length) {
  std::sort(nodes.begin(), nodes.end());
  std::vector<double> kept{0.0};
  for (double s : nodes)
    if (s > kept.back() + 1e-8 * length && s < length * (1 - 1e-8)) kept.push_back(s);
  kept.push_back(length);
  return kept;
}

/// Square of the rate of the parabola over time that is optimal without friction from rest to rest:
///   u = 6 L/T tau (1 - tau) where s = L tau^2 (3 - 2 tau).
double parabola_squared(double length, double duration_s, double s) {
  const double share = std::clamp(1 - 2 * s / length, -1.0, 1.0);
  const double tau = 0.5 - std::sin(std::asin(share) / 3);
  const double rate = 6 * length / duration_s * tau * (1 - tau);
  return rate * rate;
}

/// Whether that parabola is within the limits of a request with a given time.
bool drives_parabola(const ProfileRequest& request, double length, double least_acceleration, double cap) {
  const double T = request.time.duration_s;
  return request.time.mode == TimeMode::fixed_time && std::isfinite(T) && T > 0 && request.start_rate == 0 &&
         request.end_rate == 0 && request.speed_caps.empty() && 6 * length <= least_acceleration * T * T &&
         2.25 * length * length <= cap * T * T && torque_is_the_same_everywhere(request);
}

/// Accelerations of the path coordinate that shape a grid.
struct RampRates {
  explicit RampRates(const ProfileRequest& request) {
    const Limits& most = request.limits;
    const auto finite = [](double value, double otherwise) {
      return std::isfinite(value) && value > 0 ? value : otherwise;
    };
    const bool turn = is_turn(request.piece);
    up = finite(turn ? most.yaw_acceleration_rad_s2 : most.acceleration_m_s2, 1.0);
    down = finite(turn ? most.yaw_acceleration_rad_s2 : most.deceleration_m_s2, up);
    yaw = most.yaw_acceleration_rad_s2 > 0 ? most.yaw_acceleration_rad_s2 : kNoLimit;
  }
  double up{}, down{};
  double yaw{};  ///< rad/s^2
};

/// The reference rate at s; `from_start`, `from_end`: squares that the ramps from both ends allow there.
double rate_under_ramps(const ProfileRequest& request, const RampRates& ramps, double length, double s,
                        double from_start, double from_end, double cap) {
  if (drives_parabola(request, length, std::min(ramps.up, ramps.down), cap))
    return std::sqrt(parabola_squared(length, request.time.duration_s, s));
  // A smooth minimum: times between nodes change gently, as those of an optimal profile do.
  return std::sqrt(1 / (1 / from_start + 1 / from_end + 1 / cap));
}

}  // namespace

std::vector<double> mandatory_nodes(const PathMotion& motion, const ProfileRequest& request) {
  std::vector<double> nodes = piece_breakpoints(request.piece);
  if (!is_turn(request.piece))
    for (const SpeedCap& cap : request.speed_caps) {
      nodes.push_back(cap.from_m);
      nodes.push_back(cap.to_m);
    }
  if (torque_may_jump(request)) add_jumps(motion, nodes);
  return without_doubles(std::move(nodes), motion.length());
}

double reference_rate(const ProfileRequest& request, double length, double s, double cap) {
  const RampRates ramps(request);
  return rate_under_ramps(request, ramps, length, s,
                          request.start_rate * request.start_rate + 2 * ramps.up * s,
                          request.end_rate * request.end_rate + 2 * ramps.down * (length - s), cap);
}

namespace {

/// Density of nodes along a stretch, from the times of a reference profile, bends and distance.
class NodeDensity {
 public:
  NodeDensity(const PathMotion& motion, const ProfileRequest& request, std::size_t count)
      : edges_(cell_edges(motion, 4 * std::max<std::size_t>(count, 50))), cumulative_(edges_.size(), 0.0) {
    const std::size_t cells = edges_.size() - 1;
    std::vector<double> time(cells), bend(cells);
    double total_time = 0, total_bend = 0;
    std::vector<PathRates> rates(cells);
    for (std::size_t i = 0; i < cells; ++i) rates[i] = motion.rates(middle(i));
    const std::vector<double> u = reference_rates(motion, request, rates);
    for (std::size_t i = 0; i < cells; ++i) {
      const auto& [along, turn, turn_slope] = rates[i];
      time[i] = width(i) / std::max(u[i], 1e-6);
      bend[i] = is_turn(request.piece) ? 0.0 : width(i) * (std::abs(turn) + std::sqrt(std::abs(turn_slope)));
      total_time += time[i];
      total_bend += bend[i];
    }
    // Bends get up to 0.4 of the nodes, by how much heading they turn; distance alone gets 0.1.
    const double bend_share = total_bend > 0 ? 0.4 * total_bend / (total_bend + 1.0) : 0.0;
    const double time_share = 0.9 - bend_share;
    for (std::size_t i = 0; i < cells; ++i)
      cumulative_[i + 1] = cumulative_[i] + time_share * time[i] / total_time +
                           (total_bend > 0 ? bend_share * bend[i] / total_bend : 0.0) +
                           0.1 * width(i) / motion.length();
  }

  /// Arc length before which a share of the nodes stands.
  [[nodiscard]] double place_of(double share) const {
    return between(cumulative_, edges_, share * cumulative_.back());
  }

  /// Share of the nodes before an arc length.
  [[nodiscard]] double share_of(double s) const {
    return between(edges_, cumulative_, s) / cumulative_.back();
  }

 private:
  static constexpr double kMostTurn_rad = 0.02;  ///< of a cell
  static constexpr int kMostCuts = 12;

  /// Equal cells, those cut in which the heading turns more: near a turn in place most of the time passes on
  /// a thousandth of the length.
  static std::vector<double> cell_edges(const PathMotion& motion, std::size_t cells) {
    std::vector<double> edges{0.0};
    const double length = motion.length();
    const bool turn = is_turn(motion.piece());
    double before = std::abs(motion.rates(0).turn);
    for (std::size_t i = 1; i <= cells; ++i) {
      const double to = length * static_cast<double>(i) / static_cast<double>(cells);
      const double after = std::abs(motion.rates(to).turn);
      if (!turn) cut_turns(motion, {edges.back(), before}, {to, after}, kMostCuts, edges);
      edges.push_back(to);
      before = after;
    }
    return edges;
  }

  struct Bend {
    double s{}, turn{};
  };
  static void cut_turns(const PathMotion& motion, const Bend& from, const Bend& to, int cuts,
                        std::vector<double>& edges) {
    if (cuts == 0 || std::max(from.turn, to.turn) * (to.s - from.s) <= kMostTurn_rad) return;
    const double s = 0.5 * (from.s + to.s);
    const Bend here{s, std::abs(motion.rates(s).turn)};
    cut_turns(motion, from, here, cuts - 1, edges);
    edges.push_back(s);
    cut_turns(motion, here, to, cuts - 1, edges);
  }

  /// Of the cells: as reference_rate, with ramps that yaw acceleration flattens where the path bends.
  std::vector<double> reference_rates(const PathMotion& motion, const ProfileRequest& request,
                                      const std::vector<PathRates>& rates) const {
    const RampRates ramps(request);
    const auto half_gain = [&](std::size_t i, double most) {
      return width(i) * std::min(most, ramps.yaw / std::abs(rates[i].turn));
    };
    std::vector<double> from_start(rates.size()), u(rates.size());
    double square = request.start_rate * request.start_rate;
    for (std::size_t i = 0; i < rates.size(); ++i) {
      from_start[i] = square + half_gain(i, ramps.up);
      square += 2 * half_gain(i, ramps.up);
    }
    square = request.end_rate * request.end_rate;
    for (std::size_t i = rates.size(); i-- > 0; square += 2 * half_gain(i, ramps.down)) {
      const double s = middle(i);
      u[i] = rate_under_ramps(request, ramps, motion.length(), s, from_start[i],
                              square + half_gain(i, ramps.down), rate_cap_squared(request, rates[i], s));
    }
    return u;
  }

  double width(std::size_t i) const { return edges_[i + 1] - edges_[i]; }
  double middle(std::size_t i) const { return 0.5 * (edges_[i] + edges_[i + 1]); }

  /// y at x, linear between the pairs.
  static double between(const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto after = std::upper_bound(x.begin(), x.end(), at);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - x.begin() - 1, 0, static_cast<std::ptrdiff_t>(x.size()) - 2));
    return y[i] + std::clamp((at - x[i]) / (x[i + 1] - x[i]), 0.0, 1.0) * (y[i + 1] - y[i]);
  }

  std::vector<double> edges_;  ///< of the cells
  std::vector<double> cumulative_;
};

}  // namespace

/// Between mandatory nodes the free ones are spread evenly in the density.
std::vector<double> make_grid(const PathMotion& motion, const ProfileRequest& request, std::size_t count) {
  const std::vector<double> nodes = mandatory_nodes(motion, request);
  const NodeDensity density(motion, request, count);
  std::vector<double> grid{0.0};
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const double from = density.share_of(nodes[k]), to = density.share_of(nodes[k + 1]);
    const auto parts = static_cast<std::size_t>(
        std::max(1.0, std::round((to - from) * static_cast<double>(std::max<std::size_t>(count, 2)))));
    for (std::size_t i = 1; i < parts; ++i)
      grid.push_back(
          density.place_of(from + (to - from) * static_cast<double>(i) / static_cast<double>(parts)));
    grid.push_back(nodes[k + 1]);
  }
  // Rounding can put a node upon its neighbor: such a node is left out.
  return without_doubles(std::move(grid), motion.length());
}

std::vector<double> cut_by_excess(const std::vector<double>& s, const std::vector<double>& excess,
                                  double allowed, const std::vector<double>& places) {
  constexpr double kMostParts = 4;
  constexpr double kNear = 1e-3;  // of a segment: a place this close to a node is there already
  std::vector<double> grid{s.front()};
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const double ds = s[k + 1] - s[k];
    const std::size_t before = grid.size();
    if (excess[k] > allowed)
      for (double place : places)
        if (place > grid.back() + kNear * ds && place < s[k + 1] - kNear * ds) grid.push_back(place);
    // The excess of a part over the least cost falls with the cube of its length.
    const double parts = std::clamp(std::ceil(std::cbrt(excess[k] / allowed) - 0.3), 1.0, kMostParts);
    if (grid.size() == before)
      for (double i = 1; i < parts; ++i) grid.push_back(s[k] + ds * i / parts);
    grid.push_back(s[k + 1]);
  }
  return grid;
}

std::vector<double> cut_segments(const std::vector<double>& s, const std::vector<bool>& cut) {
  std::vector<double> grid{s.front()};
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    if (cut[k]) grid.push_back(0.5 * (s[k] + s[k + 1]));
    grid.push_back(s[k + 1]);
  }
  return grid;
}

}  // namespace joulepath::nlp
