#include "planner/joint/motor_rows.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::joint {
namespace {

using Eigen::VectorXd;

constexpr double kUnused = 0.1;       ///< unused share of a limit below which its row joins
constexpr double kLeastSlack = 2e-2;  ///< of a row that begins

/// Motion of the robot and signs of its wheels at an end of a part.
template <class Real>
struct EndState {
  BodyMotion<Real> body{};
  Sided<Real> sign{};

  EndState(const DriveLaw& law, const SpeedPart& part, const std::array<Real, kSegmentVariables>& x,
           std::size_t end) {
    using std::sqrt;
    const PartMotion<Real> motion(law, x, 1.0 / x[4], part.f1 - part.f0);
    const double f = end == 0 ? part.f0 : part.f1;
    const Real A = motion.rates.A(f), W = motion.rates.W(f);
    body = motion.at(A, W, sqrt(x[end]), x[end]);
    for (const Side side : kSides) sign[side] = wheel_sign(law, side, A, W);
  }
};

/// Use of a limit of a law, by its index.
template <class Real>
Real use_of(const DriveLaw& law, std::size_t limit, const EndState<Real>& at) {
  if (limit < law.wheel_limits.size()) {
    const WheelLimit& wheel = law.wheel_limits[limit];
    return value_of(wheel.form, at.body, at.sign[wheel.side]) * (1 / wheel.most);
  }
  const PowerLimit& power = law.power_limits[limit - law.wheel_limits.size()];
  Real sum(0.0);
  for (const Side side : kSides)
    if (power.share[side] != 0)
      sum += motor_power_W(law.wheel[side], at.body, at.sign[side]) * (power.share[side] / power.most_W);
  return sum;
}

}  // namespace

template <class Real>
Real MotorRows::unused(const At& at, const VectorXd& squares, const VectorXd& parameters) const {
  const SpeedPart& part = parts_[at.part];
  const EndState<Real> state(law(at.part), part, variables_of<Real>(part, at.part, squares, parameters),
                             at.end);
  return 1.0 - use_of(law(at.part), at.limit, state) * at.sign;
}

void MotorRows::join(const VectorXd& squares, const VectorXd& parameters, double mu) {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const DriveLaw& law = this->law(k);
    const std::size_t wheels = law.wheel_limits.size(), count = wheels + law.power_limits.size();
    if (count == 0) continue;
    const auto x = variables_of<double>(parts_[k], k, squares, parameters);
    for (std::size_t end = 0; end < 2; ++end) {
      const EndState<double> state(law, parts_[k], x, end);
      for (std::size_t limit = 0; limit < count; ++limit) {
        const double use = use_of(law, limit, state);
        const At at{k, end, limit, limit < wheels && use < 0 ? -1.0 : 1.0};
        if (1 - at.sign * use > kUnused) continue;
        const auto same = [&at](const MotorRow& row) { return row.at == at; };
        if (std::any_of(rows_.begin(), rows_.end(), same)) continue;
        rows_.emplace_back().at = at;
        rows_.back().row.begin(1 - at.sign * use, kLeastSlack, mu);
      }
    }
  }
}

MotorRows::Sums MotorRows::assemble(const VectorXd& squares, const VectorXd& parameters, double mu,
                                    BorderedSystem& system) {
  Sums sums;
  for (MotorRow& each : rows_) {
    each.value = unused<nlp::JetOf<kSegmentVariables>>(each.at, squares, parameters);
    Row& row = each.row;
    row.value = each.value.value;
    const double push = row.push(mu), stiffness = row.stiffness();
    std::array<double, kSegmentVariables> gradient{}, lagrangian{};
    std::array<double, BorderedSystem::kPartUnknowns*(BorderedSystem::kPartUnknowns + 1) / 2> hessian{};
    for (std::size_t i = 0, n = 0; i < kSegmentVariables; ++i) {
      gradient[i] = -push * each.value.d[i];
      lagrangian[i] = -row.z * each.value.d[i];
      for (std::size_t j = 0; j <= i; ++j, ++n)
        hessian[n] = stiffness * each.value.d[i] * each.value.d[j] - row.z * each.value.dd[n];
    }
    system.add(each.at.part, gradient, lagrangian, hessian);
    sums.complementarity += row.s * row.z;
    sums.primal += std::abs(row.residual()) * row.z;
  }
  return sums;
}

void MotorRows::step(const UnknownVector& step, double mu, StepLengths& lengths) {
  for (MotorRow& each : rows_) {
    const auto changes = changes_of(parts_[each.at.part], step);
    double change = 0;
    for (std::size_t i = 0; i < changes.size(); ++i) change += each.value.d[i] * changes[i];
    each.row.step(change, mu, lengths);
  }
}

std::vector<double> MotorRows::values(const VectorXd& squares, const VectorXd& parameters) const {
  std::vector<double> all;
  for (const MotorRow& each : rows_) all.push_back(unused<double>(each.at, squares, parameters));
  return all;
}

std::vector<double> MotorRows::present() const {
  std::vector<double> all;
  for (const MotorRow& each : rows_) all.push_back(each.row.value);
  return all;
}

double MotorRows::merit(const std::vector<double>& values, double step, double mu, double weight) const {
  double sum = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) sum += rows_[i].row.merit(step, values[i], mu, weight);
  return sum;
}

void MotorRows::take(const std::vector<double>& values, double primal, double dual, double mu) {
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].row.take(primal, dual, values[i], mu);
}

}  // namespace joulepath::joint
