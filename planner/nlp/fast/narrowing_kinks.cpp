#include "planner/nlp/fast/narrowing_kinks.hpp"

#include <algorithm>
#include <cmath>
// Design: docs/decisions/0301-solvers.md
namespace joulepath::nlp {
namespace {

constexpr double kFirstShare = 0.3;  ///< first width, of the greatest current and the first gap
constexpr double kNarrowing = 0.4;   ///< width after an iteration, at least, of the width before
constexpr double kProgress = 0.7;    ///< where an iteration leaves more of what is open, caution grows
constexpr double kCautionStep = 4, kMostCaution = 100;

double greatest_current_A(const Problem& problem, const std::vector<double>& b) {
  double greatest_A = 0;
  for (std::size_t k = 0; k < problem.segment_count(); ++k) {
    const Interval<double> interval = plain_interval(problem.segments[k], b[k], b[k + 1]);
    for (Side side : kSides)
      greatest_A = std::max(greatest_A, std::abs(load_at(interval, kLimitPoints / 2, side).current_A));
  }
  return greatest_A;
}

}  // namespace

bool has_kinks(const Problem& problem) {
  const Plant& plant = *problem.segments.front().plant;
  return plant.torque_loss_fraction != 0 || plant.driver_voltage_drop_V != 0;
}

NarrowingKinks::NarrowingKinks(const Problem& problem, double least_width)
    : original_(problem), least_width_(least_width) {
  if (!has_kinks(problem)) return;
  rounded_ = problem;
  for (Segment& segment : rounded_->segments) segment.rounding = &rounding_;
}

void NarrowingKinks::start(const std::vector<double>& b, double gap) {
  if (!rounded_) return;
  first_width_ = std::max(least_width_, kFirstShare * gap * greatest_current_A(*rounded_, b));
  rounding_ = {first_width_, first_width_};
}

void NarrowingKinks::narrow(double open) {
  const double before = rounding_.width;
  rounding_.width = std::min(
      before, std::max({least_width_, kNarrowing * before, std::min(1.0, std::sqrt(open)) * first_width_}));
  const bool stuck = open > kProgress * open_before_;
  caution_ = std::clamp(stuck ? kCautionStep * caution_ : caution_ / kCautionStep, 1.0, kMostCaution);
  rounding_.width_before = std::max(before, caution_ * rounding_.width);
  open_before_ = open;
}

bool NarrowingKinks::has_converged() const { return !rounded_ || rounding_.width <= least_width_; }

}  // namespace joulepath::nlp
