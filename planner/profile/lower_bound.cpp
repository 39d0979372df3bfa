#include "planner/profile/lower_bound.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>

// Method: [Brent1973]
namespace joulepath {
namespace {

constexpr std::array<double, 5> kShares{1e-4, 0.25, 0.5, 0.75, 1 - 1e-4};  ///< of a segment's time
constexpr double kSlowest = 1e-3;    ///< smallest sampled rate, as a share of the profile's
constexpr int kBits = 16;            ///< of the minimum's place
constexpr double kLeftOver = 1e-10;  ///< of the minimum, relative: error of so many bits
constexpr double kElsewhere = 0.1;   ///< share of a gap
constexpr double kSame = 1e-6;       ///< relative to H

/// The integrand at one place, scaled by the profile's rate u0: for x = u/u0, psi = psi_u2 + c,
///   G(x, a) = (H(x u0, a) - c a)/x - bend x^2 - psi_u2 a,   bend = (u0 dpsi/dt - psi_u2 a0)/2.
class Place {
 public:
  Place(const CostModel& model, const ProfileState& state, double psi, double psi_per_second, double of_rate)
      : cost_(model, state.s, state.time_s),
        rate_(state.rate),
        psi_(psi - of_rate),
        of_rate_(of_rate),
        bend_(0.5 * (psi_per_second * state.rate - psi_ * state.acceleration)),
        planned_(cost_.at(state.rate, state.acceleration) - bend_ - psi * state.acceleration),
        size_(std::abs(planned_) + std::abs(bend_) + std::abs(psi * state.acceleration)),
        most_(cost_.fastest() / rate_) {}

  double at(double x) const { return cost_.least(x * rate_, x * psi_ + of_rate_) / x - bend_ * x * x; }
  double planned() const { return planned_; }
  double size() const { return size_; }

  /// Least value around x.
  double near(double x) const {
    const double high = std::min(most_, 1.5 * x), low = x / 1.5;
    if (!(low < high)) return at(std::min(most_, low));
    std::uintmax_t iterations = 40;
    const auto function = [this](double y) { return at(y); };
    const double inner = boost::math::tools::brent_find_minima(function, low, high, kBits, iterations).second;
    return std::min({inner, at(high), at(low)});
  }

  /// Place of the least value among rates from slow to fast.
  double scan() const {
    const double high = std::isfinite(most_) ? most_ : 1e3;
    double best = high, least = at(high);
    for (double x = high; x > kSlowest; x *= x > 0.3 && x < 3 ? 0.85 : 0.6)
      if (const double value = at(x); value < least) best = x, least = value;
    return best;
  }

  /// True if G is unbounded below towards standstill.
  bool creeps() const { return cost_.least(0.0, of_rate_) < -kSame * size_; }

 private:
  PlaceCost cost_;
  double rate_{}, psi_{}, of_rate_{}, bend_{}, planned_{}, size_{}, most_{};
};

class SegmentGap {
 public:
  SegmentGap(const CostModel& model, const Costate& costate, const Profile& profile, std::size_t k)
      : model_(model), costate_(costate), profile_(profile), k_(k) {}

  /// Adds the segment's part to the gap.
  void add_to(DualGap& gap) const {
    const double dt = profile_.time_s[k_ + 1] - profile_.time_s[k_];
    const Place middle = place(0.5);
    if (middle.creeps()) {
      gap.of_segment[k_] = gap.elsewhere = kNoLimit;
      return;
    }
    const double best = middle.scan(), around = middle.near(1.0), there = middle.near(best);
    const bool elsewhere = there < around - kSame * middle.size();
    std::array<double, 5> excess;
    for (std::size_t i = 0; i < kShares.size(); ++i) {
      const Place here = place(kShares[i]);
      const double least = elsewhere ? std::min(here.near(here.scan()), here.near(1.0)) : here.near(1.0);
      excess[i] = std::max(0.0, here.planned() - least) + kLeftOver * here.size();
    }
    const auto& e = excess;
    const double coarse = dt / 6 * (e[0] + 4 * e[2] + e[4]);
    const double fine = dt / 12 * (e[0] + 4 * e[1] + 2 * e[2] + 4 * e[3] + e[4]);
    gap.of_segment[k_] = fine + std::abs(fine - coarse);
    if (elsewhere) gap.elsewhere += dt * (around - there);
  }

 private:
  Place place(double share) const {
    const double begin = profile_.time_s[k_], dt = profile_.time_s[k_ + 1] - begin;
    const double psi0 = costate_.psi_start[k_], psi1 = costate_.psi_end[k_];
    return Place(model_, profile_.at_time(begin + share * dt), psi0 + share * (psi1 - psi0),
                 (psi1 - psi0) / dt, costate_.of_rate);
  }

  const CostModel& model_;
  const Costate& costate_;
  const Profile& profile_;
  std::size_t k_{};
};

/// Bound of the effect of a jump of p: the square of the rate may be anything from 0 to the largest there.
double at_node(const CostModel& model, const Profile& profile, std::size_t k, double jump) {
  if (jump == 0) return 0.0;
  const double own = profile.rate[k] * profile.rate[k];
  if (jump < 0) return -jump * own;
  const double s = profile.s[k], inset = 1e-9 * profile.s.back();
  const double largest = std::min(PlaceCost(model, s - inset, profile.time_s[k]).largest_square(),
                                  PlaceCost(model, s + inset, profile.time_s[k]).largest_square());
  return jump * std::max(0.0, largest - own);
}

}  // namespace

double DualGap::total() const { return std::accumulate(of_segment.begin(), of_segment.end(), at_nodes); }

bool DualGap::is_elsewhere() const { return elsewhere > 0 && elsewhere >= kElsewhere * total(); }

DualGap dual_gap(const CostModel& model, const Costate& costate, const Profile& profile) {
  const std::size_t count = profile.s.size() - 1;
  DualGap gap{.of_segment = std::vector<double>(count, 0.0)};
  for (std::size_t k = 0; k < count && std::isfinite(gap.elsewhere); ++k)
    SegmentGap(model, costate, profile, k).add_to(gap);
  for (std::size_t k = 1; k < count; ++k) gap.at_nodes += at_node(model, profile, k, costate.jump[k]);
  return gap;
}

}  // namespace joulepath
