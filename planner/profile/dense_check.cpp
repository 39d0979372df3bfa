#include "planner/profile/dense_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "planner/motion/limit_check.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath::nlp {
namespace {

/// Samples per segment, equal in time: where it begins or ends at rest, the rate is not smooth in s.
constexpr std::size_t kSamples = 8;
constexpr double kWorthSampling =
    1 - 1e-3;  ///< the peak of a limit with a smaller use is below 1 between two samples
constexpr std::size_t kPeakSamples = 3;
constexpr double kSamePeak = 1e-7;   ///< a peak that is higher by less ends the search for it
constexpr double kTolerated = 3e-7;  ///< relative
constexpr double kCoarse = 5e-3;     ///< a larger violation needs a node, not only tightening

/// Where a parabola through three points has its peak; no number where it has none.
double peak_of(const std::array<double, 3>& at, const std::array<double, 3>& value) {
  const double left = (at[1] - at[0]) * (value[1] - value[2]),
               right = (at[2] - at[1]) * (value[1] - value[0]);
  if (left + right <= 0) return std::numeric_limits<double>::quiet_NaN();
  return at[1] - 0.5 * ((at[1] - at[0]) * left - (at[2] - at[1]) * right) / (left + right);
}

/// Samples the limits of one segment; between the samples it checks the peak of a parabola through three of
/// them, then of the parabola through that peak and its neighbors: on a long segment the first one is beside
/// the limit's peak.
class SegmentSamples {
 public:
  SegmentSamples(const ProfileRequest& request, const PathMotion& motion, const Profile& profile,
                 std::size_t k)
      : request_(request),
        motion_(motion),
        profile_(profile),
        from_s_(profile.time_s[k]),
        duration_s_(profile.time_s[k + 1] - profile.time_s[k]),
        jerk_(profile.jerk[k]) {}

  /// Worst use of each limit, by name.
  std::vector<std::pair<std::string_view, double>> worst_uses() const {
    std::vector<Uses> all;
    for (std::size_t i = 0; i <= kSamples; ++i)
      sample(static_cast<double>(i) / kSamples, [&](std::string_view name, double ratio) {
        auto uses = std::find_if(all.begin(), all.end(), [&](const Uses& some) { return some.name == name; });
        if (uses == all.end()) uses = all.insert(all.end(), {.name = name});
        uses->ratio[i] = std::max(uses->ratio[i], ratio);
      });
    std::sort(all.begin(), all.end(), [](const Uses& a, const Uses& b) { return a.name < b.name; });
    std::vector<std::pair<std::string_view, double>> worst;
    for (const Uses& uses : all) worst.emplace_back(uses.name, std::max(peak(uses.name, uses.ratio), 0.0));
    return worst;
  }

 private:
  struct Uses {
    std::string_view name{};
    std::array<double, kSamples + 1> ratio{};
  };
  /// The limits at a share of the segment's time.
  template <class Use>
  void sample(double share, Use&& use) const {
    const ProfileState state = profile_.at_time(from_s_ + duration_s_ * std::clamp(share, 1e-7, 1 - 1e-7));
    for_each_limit_use(motion_, request_.limits, request_.speed_caps, state, jerk_, use);
  }

  double peak(std::string_view name, const std::array<double, kSamples + 1>& ratios) const {
    double most = *std::max_element(ratios.begin(), ratios.end());
    if (most < kWorthSampling || !std::isfinite(most)) return most;
    for (std::size_t i = 1; i < kSamples; ++i) {
      const auto own = static_cast<double>(i);
      std::array<double, 3> at{own - 1, own, own + 1}, value{ratios[i - 1], ratios[i], ratios[i + 1]};
      // The parabola beside an end of the segment holds up to that end.
      const double first = i == 1 ? 0.0 : own - 0.5, last = i + 1 == kSamples ? own + 1.0 : own + 0.5;
      for (std::size_t k = 0; k < kPeakSamples; ++k) {
        const double top = peak_of(at, value);
        if (!(top >= first && top <= last) ||
            ratios[static_cast<std::size_t>(std::lround(top))] < kWorthSampling)
          break;
        const double found = use_of(name, top / kSamples), higher = found - value[1];
        most = std::max(most, found);
        if (higher < kSamePeak) break;
        const std::size_t side = top > at[1] ? 0 : 2;  // the old middle is the new neighbor there
        at[side] = at[1], value[side] = value[1];
        at[1] = top, value[1] = found;
      }
    }
    return most;
  }

  /// The largest use of one limit at a share of the segment's time.
  double use_of(std::string_view name, double share) const {
    double most = 0;
    sample(share, [&](std::string_view limit, double ratio) {
      if (limit == name) most = std::max(most, ratio);
    });
    return most;
  }

  const ProfileRequest& request_;
  const PathMotion& motion_;
  const Profile& profile_;
  double from_s_{}, duration_s_{}, jerk_{};
};

}  // namespace

std::vector<double> counted_energy_J(const Problem& problem, const std::vector<double>& b) {
  std::vector<double> energy_J;
  for (std::size_t k = 0; k < problem.segment_count(); ++k)
    energy_J.push_back(kept_energy_J(plain_interval(problem.segments[k], b[k], b[k + 1])));
  return energy_J;
}

DenseCheck check_densely(const Problem& problem, const PathMotion& motion, const Profile& profile,
                         const std::vector<double>& counted_energy_J, double accuracy) {
  const ProfileRequest& request = *problem.request;
  const std::size_t count = problem.segment_count();
  DenseCheck result{.cut = std::vector<bool>(count, false)};
  std::vector<double> error_J(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double from = profile.s[k], ds = profile.s[k + 1] - from;
    const auto worst = SegmentSamples(request, motion, profile, k).worst_uses();
    for (const auto& [name, ratio] : worst) {
      result.worst_ratio = std::max(result.worst_ratio, ratio);
      if (ratio <= 1 + kTolerated || !std::isfinite(ratio)) continue;
      const std::string_view limit = name == "deceleration" ? std::string_view("acceleration") : name;
      result.tighten.push_back({limit, from, from + ds, (1 - 5e-8) / ratio});
      if (ratio > 1 + kCoarse) result.cut[k] = true;
    }
    const double exact_J = segment_energy_J(motion, profile, k);
    error_J[k] = counted_energy_J[k] - exact_J;
    result.energy_J += exact_J;
  }
  double sum_J = 0, size_J = 0;
  for (double e : error_J) sum_J += e, size_J += std::abs(e);
  result.energy_error_J = std::abs(sum_J);
  const double total_J = std::max(std::abs(result.energy_J), 1e-9);
  if (result.energy_error_J > accuracy * total_J)
    for (std::size_t k = 0; k < count; ++k)
      if (std::abs(error_J[k]) > 0.2 * size_J / static_cast<double>(count)) result.cut[k] = true;
  return result;
}

}  // namespace joulepath::nlp
