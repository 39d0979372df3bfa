#include "diagnosis/evidence/region_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0503-evidence.md
namespace joulepath {
namespace {

/// Rolling coefficient that a sample asks for beyond the model, and where.
struct PlacedSample {
  std::array<double, 2> at_m{};
  double coefficient{};
};

struct Rectangle {
  std::array<double, 2> low_m{}, high_m{};
  double contrast{};
};

/// Resistance that a sample shows beyond the model, from the motors' currents; without them from the
/// battery's power over the speed.
std::optional<double> missing_force_N(const RunSignals& run, const ResidualRows& rows, const Robot& robot,
                                      Eigen::Index j) {
  if (rows.present(j, kCurrentLeft) && rows.present(j, kCurrentRight)) {
    double torque_Nm = 0;
    for (Side side : kSides) {
      const double direction = run.wheel_speed_rad_s[side][j] > 0 ? 1 : -1;
      torque_Nm += direction * rows.value(j, side == Side::left ? kCurrentLeft : kCurrentRight) *
                   robot.motor[side].torque_per_ampere_Nm_A();
    }
    return torque_Nm / robot.geometry.wheel_radius_m.left;
  }
  double speed_m_s = 0;
  for (Side side : kSides)
    speed_m_s += 0.5 * std::abs(run.wheel_speed_rad_s[side][j]) * robot.geometry.wheel_radius_m[side];
  if (measures_motors(run) || !rows.present(j, kDriverPower) || speed_m_s < kMoving_m_s) return {};
  return rows.value(j, kDriverPower) / speed_m_s;
}

std::vector<PlacedSample> placed_samples(const std::vector<RunSignals>& signals, const Robot& robot,
                                         const std::vector<Nuisance>& nuisances, ModelState state,
                                         const EffectDescription& effect) {
  std::erase_if(state.effects,
                [&](const ActiveEffect& e) { return e.candidate.shape.name == effect.info.name; });
  std::vector<PlacedSample> samples;
  for (const RunSignals& run : signals) {
    if (run.x_m.size() == 0) return {};
    const ModelPoint point = model_point(robot, nuisances, state);
    const ResidualRows rows = residual_rows(run, point, predict(run, point));
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      const std::optional<double> force_N = missing_force_N(run, rows, robot, j);
      if (!force_N) continue;
      const double load_N = kGravity_m_s2 * robot.total_mass_kg(run.payload_kg[j]);
      samples.push_back({{run.x_m[j], run.y_m[j]}, *force_N / load_N});
    }
  }
  return samples;
}

/// The interval of one coordinate, among samples inside of the other's interval, with the greatest
/// (sum)^2/count above the mean outside.
void best_interval(const std::vector<PlacedSample>& samples, int axis, Rectangle& rectangle) {
  const auto a = static_cast<std::size_t>(axis), other = 1 - a;
  double least = 1e300, greatest = -1e300;
  for (const PlacedSample& s : samples) {
    least = std::min(least, s.at_m[a]), greatest = std::max(greatest, s.at_m[a]);
  }
  if (samples.empty()) return;
  const auto bins =
      static_cast<std::size_t>(std::clamp((greatest - least) / kRegionStep_m + 1, 1.0, kMostRegionSteps));
  const double width = std::max(1e-9, (greatest - least) / static_cast<double>(bins));
  std::vector<double> sum(bins + 1, 0.0), count(bins + 1, 0.0);
  double all_sum = 0, all_count = 0;
  for (const PlacedSample& s : samples) {
    all_sum += s.coefficient, all_count += 1;
    if (s.at_m[other] < rectangle.low_m[other] || s.at_m[other] > rectangle.high_m[other]) continue;
    const auto bin = std::min(bins - 1, static_cast<std::size_t>((s.at_m[a] - least) / width));
    sum[bin + 1] += s.coefficient, count[bin + 1] += 1;
  }
  for (std::size_t b = 0; b < bins; ++b) sum[b + 1] += sum[b], count[b + 1] += count[b];
  double best = 0;
  for (std::size_t lo = 0; lo < bins; ++lo)
    for (std::size_t hi = lo + 1; hi <= bins; ++hi) {
      const double n = count[hi] - count[lo], outside = all_count - n;
      if (n < kLeastSamplesOfRegion || outside < kLeastSamplesOfRegion) continue;
      const double inside_sum = sum[hi] - sum[lo];
      const double difference = inside_sum / n - (all_sum - inside_sum) / outside;
      const double contrast = difference > 0 ? difference * difference * n * outside / all_count : 0;
      if (contrast <= best) continue;
      best = contrast;
      rectangle.low_m[a] = lo == 0 ? least : least + static_cast<double>(lo) * width;
      rectangle.high_m[a] = hi == bins ? greatest : least + static_cast<double>(hi) * width;
    }
  rectangle.contrast = best;
}

Rectangle search(const std::vector<PlacedSample>& samples, int first_axis) {
  Rectangle rectangle{.low_m = {-1e9, -1e9}, .high_m = {1e9, 1e9}};
  for (int step = 0; step < 4; ++step) best_interval(samples, (first_axis + step) % 2, rectangle);
  best_interval(samples, first_axis, rectangle);
  return rectangle;
}

/// The effect in that region; none where the catalog accepts no place so far from the origin.
std::optional<Candidate> candidate_of(const EffectDescription& effect, const Rectangle& rectangle,
                                      const Robot& robot) {
  Candidate candidate = bare_candidate(effect, robot);
  const std::array edges_m{rectangle.low_m[0], rectangle.high_m[0], rectangle.low_m[1], rectangle.high_m[1]};
  std::size_t next = 0;
  for (const ParameterDescription& parameter : effect.parameters) {
    if (parameter.role == ParameterRole::edge) {
      const double edge_m = edges_m[next++];
      if (edge_m < parameter.min || edge_m > parameter.max) return std::nullopt;
      candidate.shape.parameters[parameter.name] = edge_m;
    }
    if (parameter.role == ParameterRole::shape)
      candidate.shape.parameters[parameter.name] = typical_size(parameter, robot);
  }
  return candidate;
}

}  // namespace

std::vector<Candidate> region_candidates(const std::vector<RunSignals>& signals, const Robot& robot,
                                         const std::vector<Nuisance>& nuisances, const ModelState& state,
                                         const std::set<std::string>& without) {
  std::vector<Candidate> candidates;
  for (const EffectDescription& effect : effect_catalog()) {
    if (!effect.has_region || without.contains(std::string(effect.info.name))) continue;
    const std::vector<PlacedSample> samples = placed_samples(signals, robot, nuisances, state, effect);
    for (int axis : {0, 1}) {
      const Rectangle rectangle = search(samples, axis);
      if (!(rectangle.contrast > 0)) continue;
      if (auto candidate = candidate_of(effect, rectangle, robot))
        candidates.push_back(*std::move(candidate));
    }
  }
  return candidates;
}

}  // namespace joulepath
