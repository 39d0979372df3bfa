#include "model/simulation/integrator.hpp"

// Odeint copies its steppers' work arrays before their first use.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_cash_karp54.hpp>
#include <cmath>

#include "model/assert.hpp"

// Method: [CashKarp1990]
namespace joulepath {
namespace {

namespace odeint = boost::numeric::odeint;
using Stepper = odeint::runge_kutta_cash_karp54<DriveState>;

constexpr double kSmallestStep_s = 1e-9;

}  // namespace

DriveIntegrator::DriveIntegrator(Drive drive, const DriveState& start, const IntegratorOptions& options)
    : drive_(std::move(drive)), state_(start), options_(options), step_s_(options.max_step_s) {
  for (Surface s : kAllSurfaces) mode_[s] = static_cast<int>(sign_of(state_[kVelocity + s]));
}

/// Whether a sliding surface has passed through rest.
bool DriveIntegrator::turned(const DriveState& state, Surface surface) const {
  return drive_.is_active(surface) && mode_[surface] != 0 && mode_[surface] * state[kVelocity + surface] < 0;
}

bool DriveIntegrator::corner(const DriveState& state, double time_s) const {
  bool holding = false;
  for (Surface s : kAllSurfaces) {
    if (turned(state, s)) return true;
    holding |= drive_.is_active(s) && mode_[s] == 0;
  }
  if (!holding) return false;
  const FrictionMode release = drive_.evaluate(state, time_s, mode_).release;
  for (int direction : release)
    if (direction != 0) return true;
  return false;
}

/// Releases the holding surfaces whose load exceeds friction.
void DriveIntegrator::break_away() {
  bool holding = false;
  for (Surface s : kAllSurfaces) holding |= drive_.is_active(s) && mode_[s] == 0;
  if (!holding) return;
  const FrictionMode release = drive_.evaluate(state_, time_s_, mode_).release;
  for (Surface s : kAllSurfaces)
    if (release[s] != 0) {
      mode_[s] = release[s];
      ++events_;
    }
}

/// Stops surfaces that have just reversed, and holding surfaces that moved by the width of the last
/// bisection.
void DriveIntegrator::settle() {
  for (Surface s : kAllSurfaces) {
    if (!drive_.is_active(s)) continue;
    if (turned(state_, s)) {
      mode_[s] = 0;
      ++events_;
    }
  }
  for (Surface s : kAllSurfaces)
    if (drive_.is_active(s) && mode_[s] == 0 && state_[kVelocity + s] != 0.0) drive_.stop(state_, s);
}

/// Shortest step from a state that just passes a corner; `beyond` is the state there.
double DriveIntegrator::locate_corner(const DriveState& from, double step_s, DriveState& beyond) const {
  const auto system = [this](const DriveState& x, DriveState& rate, double t) {
    rate = drive_.evaluate(x, t, mode_).derivative;
  };
  Stepper stepper;
  double before_s = 0;
  double after_s = step_s;
  for (int i = 0; i < 60 && after_s - before_s > 1e-3 * kSmallestStep_s; ++i) {
    const double middle_s = 0.5 * (before_s + after_s);
    DriveState there = from;
    stepper.do_step(system, there, time_s_, middle_s);
    if (corner(there, time_s_ + middle_s)) {
      after_s = middle_s;
      beyond = there;
    } else {
      before_s = middle_s;
    }
  }
  return after_s;
}

void DriveIntegrator::advance_to(double end_s) {
  const auto system = [this](const DriveState& x, DriveState& rate, double t) {
    const Drive::Instant instant = drive_.evaluate(x, t, mode_);
    battery_gave_way_ |= instant.battery_gives_way;
    rate = instant.derivative;
  };
  auto stepper = odeint::make_controlled(options_.tolerance, options_.tolerance, Stepper());
  break_away();
  while (end_s - time_s_ > 1e-12) {
    JOULEPATH_ASSERT(++steps_ < 100000000, "the simulation does not advance");
    const DriveState before = state_;
    const double from_s = time_s_;
    const double asked_s = std::min({step_s_, options_.max_step_s, end_s - time_s_});
    double next_s = asked_s;
    if (stepper.try_step(system, state_, time_s_, next_s) == odeint::fail) {
      JOULEPATH_ASSERT(next_s > 1e-15, "the step size of the simulation became too small");
      step_s_ = next_s;
      continue;
    }
    const double taken_s = time_s_ - from_s;
    if (next_s > step_s_ || taken_s >= step_s_) step_s_ = next_s;
    if (corner(state_, time_s_)) {
      time_s_ = from_s;
      DriveState beyond = state_;
      const double step_s = locate_corner(before, taken_s, beyond);
      state_ = beyond;
      time_s_ = from_s + step_s;
    }
    settle();
    break_away();
  }
  time_s_ = end_s;
}

void DriveIntegrator::displace(double ahead_m, double left_m) {
  const double c = std::cos(state_[kYaw]), s = std::sin(state_[kYaw]);
  state_[kX] += c * ahead_m - s * left_m;
  state_[kY] += s * ahead_m + c * left_m;
}

}  // namespace joulepath
