#include "planner/nlp/transcription/jerk_program.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "planner/values/profile.hpp"
// Design: docs/decisions/0302-jerk.md
namespace joulepath::nlp {
namespace {

constexpr std::size_t kAccelerationTerm = 0;  ///< index in Rows: a bound on the unknown a instead of a row
constexpr double kBackOff = 1e-7;  ///< relative, of the jerk limit: reserve for the solver's tolerance

}  // namespace

double JerkMotion::duration_s() const { return std::accumulate(dt.begin(), dt.end(), 0.0); }

JerkProgram::JerkProgram(const Problem& problem, const std::vector<Tightening>& tightenings, JerkMotion guess)
    : p_(problem),
      guess_(std::move(guess)),
      rows_(problem.segment_count()),
      acceleration_(problem.node_count()) {
  for (std::size_t i = 0; i < p_.rows.size(); ++i) {
    const ActiveRow& row = p_.rows[i];
    if (row.term != kAccelerationTerm) {
      rows_[row.segment].push_back(i);
      continue;
    }
    for (std::size_t node : {row.segment, row.segment + 1}) {
      acceleration_[node].low = std::max(acceleration_[node].low, row.bounds.low);
      acceleration_[node].high = std::min(acceleration_[node].high, row.bounds.high);
    }
  }
  for (const Segment& segment : p_.segments) {
    const double factor = factor_for(tightenings, "jerk", segment.s0, segment.s0 + segment.ds);
    jerk_.push_back(p_.request->limits.jerk_m_s3 * factor * (1 - kBackOff));
  }
  const double duration_s = guess_.duration_s();
  rate_scale_ = *std::max_element(guess_.u.begin(), guess_.u.end());
  time_scale_ = duration_s / static_cast<double>(p_.segment_count());
  acceleration_scale_ = 4 * rate_scale_ / duration_s;
}

JerkProgram::JerkProgram(const JerkProgram& program, const Problem& rounded)
    : p_(rounded),
      guess_(program.guess_),
      rows_(program.rows_),
      acceleration_(program.acceleration_),
      jerk_(program.jerk_),
      rate_scale_(program.rate_scale_),
      acceleration_scale_(program.acceleration_scale_),
      time_scale_(program.time_scale_) {}

std::vector<double> JerkProgram::squares() const {
  std::vector<double> b;
  for (const double u : guess_.u) b.push_back(u * u);
  return b;
}

double JerkProgram::start(std::size_t i) const {
  if (i < inner()) return guess_.u[i + 1] / rate_scale_;
  if (i < 2 * inner()) return guess_.a[i - inner() + 1] / acceleration_scale_;
  return guess_.dt[i - 2 * inner()] / time_scale_;
}

Bounds JerkProgram::unknown_bounds(std::size_t i) const {
  if (i < inner()) return {0.0, std::sqrt(p_.cap[i + 1].squared) / rate_scale_};
  if (i >= 2 * inner()) return {0.0, kNoLimit};
  const Bounds& bounds = acceleration_[i - inner() + 1];
  return {bounds.low / acceleration_scale_, bounds.high / acceleration_scale_};
}

Bounds JerkProgram::row_bounds(std::size_t k, std::size_t i) const {
  if (i < rows_[k].size()) return p_.rows[rows_[k][i]].bounds;
  const std::size_t own = i - rows_[k].size();
  if (own < 2) return {0.0, 0.0};
  if (own == 2) return {-kNoLimit, 0.0};
  if (own == 3) return {0.0, kNoLimit};
  const double cap = 0.5 * (std::sqrt(p_.cap[k].squared) + std::sqrt(p_.cap[k + 1].squared));
  return {-kNoLimit, cap / rate_scale_};
}

Columns<JerkProgram::kLocal> JerkProgram::columns(std::size_t k) const {
  const auto node = [&](std::size_t at, std::size_t offset) {
    return at == 0 || at + 1 == p_.node_count() ? kFixed : static_cast<int>(offset + at - 1);
  };
  return {node(k, 0), node(k, inner()), node(k + 1, 0), node(k + 1, inner()),
          static_cast<int>(2 * inner() + k)};
}

std::array<double, JerkProgram::kLocal> JerkProgram::local(const double* x, std::size_t k) const {
  const Columns<kLocal> at = columns(k);
  const auto value = [&](int column, double scale, double fixed) {
    return column == kFixed ? fixed : x[column] * scale;
  };
  return {value(at[0], rate_scale_, std::sqrt(p_.b_start)), value(at[1], acceleration_scale_, 0.0),
          value(at[2], rate_scale_, std::sqrt(p_.b_end)), value(at[3], acceleration_scale_, 0.0),
          value(at[4], time_scale_, 0.0)};
}

void JerkProgram::evaluate(const double* x, std::size_t k, SegmentValues<kLocal>& values) const {
  const Segment& segment = p_.segments[k];
  const JerkInterval<JerkJet> interval =
      jet_jerk_interval(segment, local(x, k),
                        {rate_scale_, acceleration_scale_, rate_scale_, acceleration_scale_, time_scale_});
  const auto parts_J = Energy::by_point(interval);
  values.energy_J = {parts_J[0][0], parts_J[1][0], parts_J[0][1], parts_J[1][1]};
  values.duration_s = interval.dt;
  values.rows.clear();
  for (std::size_t row : rows_[k]) values.rows.push_back(evaluate_row(p_, p_.rows[row], interval));
  values.rows.push_back(interval.speed_defect() / rate_scale_);
  values.rows.push_back(interval.distance_defect() / segment.ds);
  const JerkJet change = (interval.a1 - interval.a0) / acceleration_scale_;
  const JerkJet most = interval.dt * (jerk_[k] / acceleration_scale_);
  values.rows.push_back(change - most);
  values.rows.push_back(change + most);
  values.rows.push_back((interval.u0 + 0.5 * (interval.dt * interval.a0)) / rate_scale_);
}

JerkMotion JerkProgram::motion(const std::vector<double>& x) const {
  JerkMotion motion;
  for (std::size_t k = 0; k < p_.segment_count(); ++k) {
    const std::array<double, kLocal> at = local(x.data(), k);
    if (k == 0) motion.u.push_back(at[0]), motion.a.push_back(at[1]);
    motion.u.push_back(at[2]);
    motion.a.push_back(at[3]);
    motion.dt.push_back(at[4]);
  }
  return motion;
}

JerkMotion averaged_motion(const Profile& profile, double window_s) {
  const double end_s = profile.time_s.back();
  /// Place and rate, with the given speeds at the ends outside of the profile.
  const auto state = [&](double t) {
    if (t <= 0)
      return ProfileState{.s = profile.s.front() + t * profile.rate.front(), .rate = profile.rate.front()};
    if (t >= end_s)
      return ProfileState{.s = profile.s.back() + (t - end_s) * profile.rate.back(),
                          .rate = profile.rate.back()};
    return profile.at_time(t);
  };
  JerkMotion motion;
  for (std::size_t k = 0; k < profile.s.size(); ++k) {
    const ProfileState before = state(profile.time_s[k] - window_s / 2);
    const ProfileState after = state(profile.time_s[k] + window_s / 2);
    motion.u.push_back((after.s - before.s) / window_s);
    motion.a.push_back((after.rate - before.rate) / window_s);
  }
  motion.u.front() = profile.rate.front();
  motion.u.back() = profile.rate.back();
  motion.a.front() = motion.a.back() = 0.0;
  for (std::size_t k = 0; k + 1 < profile.s.size(); ++k)
    motion.dt.push_back(2 * (profile.s[k + 1] - profile.s[k]) / (motion.u[k] + motion.u[k + 1]));
  return motion;
}

Profile profile_from_motion(const std::vector<double>& s, const JerkMotion& motion) {
  Profile profile{.time_s = {0.0}, .s = s, .rate = motion.u};
  for (std::size_t k = 0; k < motion.dt.size(); ++k) {
    profile.acceleration.push_back(motion.a[k]);
    profile.jerk.push_back((motion.a[k + 1] - motion.a[k]) / motion.dt[k]);
    profile.time_s.push_back(profile.time_s.back() + motion.dt[k]);
  }
  return profile;
}

}  // namespace joulepath::nlp
