#include "planner/profile/least_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace joulepath {
namespace {

constexpr int kSteps = 4;           ///< within a segment of the grid, a power of two
constexpr double kInset = 1e-9;     ///< of a segment: its law may change at its ends
constexpr double kRounding = 1e-9;  ///< relative, of the time

/// A square of the rate that is linear over a step.
struct Chord {
  double from{}, to{};
  double at(double share) const { return from + share * (to - from); }
};

/// Time (s) over a step below three chords; the shares of its length at which the lowest one changes are
/// appended to `changes`.
double time_below(const std::array<Chord, 3>& chords, double ds, std::vector<double>* changes) {
  const auto least = [&](double share) {
    return std::max(0.0, std::min({chords[0].at(share), chords[1].at(share), chords[2].at(share)}));
  };
  std::array<double, 5> shares{0.0, 1.0, 1.0, 1.0, 1.0};
  std::size_t count = 2;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double first = chords[i].from - chords[j].from, last = chords[i].to - chords[j].to;
      if (!(first * last < 0)) continue;
      const double share = first / (first - last);
      if (chords[i].at(share) > least(share) * (1 + 1e-12)) continue;
      shares[count++] = share;
      if (changes) changes->push_back(share);
    }
  std::sort(shares.begin(), shares.end());
  double time_s = 0;
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
    const double u = std::sqrt(least(shares[i])) + std::sqrt(least(shares[i + 1]));
    if (shares[i + 1] > shares[i]) time_s += 2 * ds * (shares[i + 1] - shares[i]) / u;
  }
  return time_s;
}

class Comparison {
 public:
  Comparison(const CostModel& model, const std::vector<double>& s, int steps)
      : model_(model),
        s_(s),
        steps_(steps),
        forward_((s.size() - 1) * static_cast<std::size_t>(steps)),
        backward_(forward_.size()),
        cap_(forward_.size()) {
    places_.reserve(2 * forward_.size() + s.size());
    for (std::size_t k = 0; k + 1 < s.size(); ++k)
      for (int i = 0; i <= 2 * steps; ++i)
        places_.emplace_back(model, at(k, std::clamp(0.5 * i / steps, kInset, 1 - kInset)), 0.0);
    sweep_forward();
    sweep_backward();
  }

  LeastTime time() const {
    LeastTime result{.of_segment_s = std::vector<double>(s_.size() - 1, 0.0)};
    std::vector<double> changes;
    for (std::size_t j = 0; j < forward_.size(); ++j) {
      const std::size_t k = segment(j);
      changes.clear();
      result.of_segment_s[k] += time_below({forward_[j], backward_[j], cap_[j]}, step_length(k), &changes);
      for (double share : changes)
        result.switches.push_back(at(k, (static_cast<double>(j % count()) + share) / steps_));
    }
    for (double part_s : result.of_segment_s) result.lower_s += part_s;
    return result;
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(steps_); }
  std::size_t segment(std::size_t j) const { return j / count(); }
  double at(std::size_t k, double share) const { return s_[k] + share * (s_[k + 1] - s_[k]); }
  double step_length(std::size_t k) const { return (s_[k + 1] - s_[k]) / steps_; }
  /// At the start (0), the middle (1) or the end (2) of step j.
  const PlaceCost& place(std::size_t j, std::size_t part) const {
    return places_[segment(j) * (2 * count() + 1) + 2 * (j % count()) + part];
  }

  /// Slope db/ds of the fastest drive, forward or (by distance from the end) backward.
  static double slope(const PlaceCost& place, double b, bool onward) {
    const nlp::Range range = place.accelerations(std::sqrt(std::max(0.0, b)));
    if (range.low > range.high) return 0.0;  // no profile exists here: the cap lowers it
    return onward ? 2 * range.high : -2 * range.low;
  }

  double step(std::size_t j, double b, bool onward) const {
    const double h = step_length(segment(j));
    const PlaceCost &first = place(j, onward ? 0 : 2), &middle = place(j, 1),
                    &last = place(j, onward ? 2 : 0);
    const double k1 = slope(first, b, onward);
    if (!std::isfinite(k1)) return kNoLimit;
    const double k2 = slope(middle, b + 0.5 * h * k1, onward), k3 = slope(middle, b + 0.5 * h * k2, onward);
    const double k4 = slope(last, b + h * k3, onward);
    return std::max(0.0, b + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4));
  }

  void sweep_forward() {
    double b = model_.request.start_rate * model_.request.start_rate;
    for (std::size_t j = 0; j < forward_.size(); ++j) {
      cap_[j] = {place(j, 0).largest_square(), place(j, 2).largest_square()};
      b = std::min(b, cap_[j].from);
      forward_[j] = {b, step(j, b, true)};
      b = std::min(forward_[j].to, cap_[j].to);
      if (std::isinf(forward_[j].to)) forward_[j] = cap_[j];
    }
  }
  void sweep_backward() {
    double b = model_.request.end_rate * model_.request.end_rate;
    for (std::size_t j = backward_.size(); j-- > 0;) {
      b = std::min(b, cap_[j].to);
      backward_[j] = {step(j, b, false), b};
      b = std::min(backward_[j].from, cap_[j].from);
      if (std::isinf(backward_[j].from)) backward_[j] = cap_[j];
    }
  }

  const CostModel& model_;
  const std::vector<double>& s_;
  int steps_{};
  std::vector<PlaceCost> places_{};
  std::vector<Chord> forward_{}, backward_{}, cap_{};  ///< by step
};

}  // namespace

LeastTime least_time(const CostModel& model, const std::vector<double>& s) {
  const LeastTime rough = Comparison(model, s, kSteps / 2).time();
  LeastTime fine = Comparison(model, s, kSteps).time();
  double change_s = 0;
  for (std::size_t k = 0; k < fine.of_segment_s.size(); ++k)
    change_s += std::abs(rough.of_segment_s[k] - fine.of_segment_s[k]);
  fine.lower_s -= change_s + kRounding * fine.lower_s;
  return fine;
}

}  // namespace joulepath
