#include "diagnosis/evidence/whitening.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0041-noise-is-what-a-fit-of-everything-leaves.md
namespace joulepath {
namespace {

using Presence = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;
using Covariance = Eigen::Matrix<double, kChannelCount, kChannelCount>;

/// Number of consecutive present samples directly before each sample, up to the order; -1 where the sample is
/// absent.
Eigen::MatrixXi history_of(const Presence& present) {
  Eigen::MatrixXi history = Eigen::MatrixXi::Constant(present.rows(), present.cols(), -1);
  for (Eigen::Index c = 0; c < present.cols(); ++c)
    for (Eigen::Index t = 0; t < present.rows(); ++t)
      if (present(t, c)) history(t, c) = t == 0 ? 0 : std::min(kAutoregressionOrder, history(t - 1, c) + 1);
  return history;
}

struct Autocovariance {
  std::array<double, kAutoregressionOrder + 1> lag{};
  double count{};
};

Autocovariance autocovariance(const std::vector<ResidualRows>& runs, int channel) {
  Autocovariance sum;
  std::array<double, kAutoregressionOrder + 1> counts{};
  for (const ResidualRows& run : runs)
    for (Eigen::Index t = 0; t < run.value.rows(); ++t)
      for (int k = 0; k <= kAutoregressionOrder && k <= t; ++k) {
        if (!run.present(t, channel) || !run.present(t - k, channel)) break;
        sum.lag[static_cast<std::size_t>(k)] += run.value(t, channel) * run.value(t - k, channel);
        counts[static_cast<std::size_t>(k)] += 1;
      }
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0) sum.lag[k] /= counts[k];
  sum.count = counts[0];
  return sum;
}

/// Standard deviation of a channel's noise, 1 without data.
double size_of(const Autocovariance& r, double least_sd) {
  return r.count > 0 ? std::hypot(std::sqrt(r.lag[0]), least_sd) : 1.0;
}

/// Yule-Walker equations for two lags.
void fit_memory(NoiseModel& noise, int channel, const Autocovariance& r, double least_sd) {
  const auto c = static_cast<std::size_t>(channel);
  noise.stationary_ratio[c] = 1.0;
  noise.channel_sd[c] = size_of(r, least_sd);
  if (r.count < kLeastSamples || r.lag[0] <= 0) return;
  const double rho1 = std::clamp(r.lag[1] / r.lag[0], -0.98, 0.98);
  const double rho2 = std::clamp(r.lag[2] / r.lag[0], -0.98, 0.98);
  double a1 = rho1 * (1 - rho2) / (1 - rho1 * rho1), a2 = (rho2 - rho1 * rho1) / (1 - rho1 * rho1);
  a2 = std::clamp(a2, -0.95, 0.95);
  a1 = std::clamp(a1, -0.98 * (1 - a2), 0.98 * (1 - a2));
  noise.memory[c] = {a1, a2};
  noise.stationary_ratio[c] = std::sqrt(std::clamp(1 - a1 * rho1 - a2 * rho2, 0.02, 1.0));
}

double innovation(const NoiseModel& noise, const Eigen::MatrixXd& rows, const Eigen::MatrixXi& history,
                  Eigen::Index t, Eigen::Index channel) {
  const auto c = static_cast<std::size_t>(channel);
  if (history(t, channel) < kAutoregressionOrder) return noise.stationary_ratio[c] * rows(t, channel);
  double value = rows(t, channel);
  for (int k = 1; k <= kAutoregressionOrder; ++k)
    value -= noise.memory[c][static_cast<std::size_t>(k - 1)] * rows(t - k, channel);
  return value;
}

/// True for channels with a common source of noise: a current enters the winding row and the driver row, the
/// battery's readings enter the driver and the supply row. Other correlations are structure, not noise.
bool share_noise(int a, int b) {
  const auto side_of = [](int c) { return c == kCurrentLeft || c == kWindingLeft ? 0 : 1; };
  const auto is_motor = [](int c) { return c <= kWindingRight; };
  if (a == b) return true;
  if (is_motor(a) && is_motor(b)) return side_of(a) == side_of(b);
  return a <= kSupplyVoltage && b <= kSupplyVoltage && (a >= kDriverPower || b >= kDriverPower);
}

/// The nearest covariance with a margin of positive definiteness.
Covariance made_positive(const Covariance& covariance) {
  Covariance scaled = covariance;
  Eigen::Matrix<double, kChannelCount, 1> sd = covariance.diagonal().cwiseMax(1e-24).cwiseSqrt();
  for (int i = 0; i < kChannelCount; ++i)
    for (int j = 0; j < kChannelCount; ++j) scaled(i, j) /= sd[i] * sd[j];
  const Eigen::SelfAdjointEigenSolver<Covariance> solver(scaled);
  Covariance fixed = solver.eigenvectors() * solver.eigenvalues().cwiseMax(1e-3).asDiagonal() *
                     solver.eigenvectors().transpose();
  for (int i = 0; i < kChannelCount; ++i)
    for (int j = 0; j < kChannelCount; ++j) fixed(i, j) *= sd[i] * sd[j];
  return fixed;
}

}  // namespace

NoiseModel estimate_noise(const std::vector<ResidualRows>& runs,
                          const std::array<double, kChannelCount>& least_sd) {
  NoiseModel noise;
  for (int c = 0; c < kChannelCount; ++c)
    fit_memory(noise, c, autocovariance(runs, c), least_sd[static_cast<std::size_t>(c)]);
  Covariance sum = Covariance::Zero(), count = Covariance::Zero();
  for (const ResidualRows& run : runs) {
    const Eigen::MatrixXi history = history_of(run.present);
    for (Eigen::Index t = 0; t < run.value.rows(); ++t) {
      std::array<double, kChannelCount> fresh{};
      for (int c = 0; c < kChannelCount; ++c)
        if (history(t, c) >= 0)
          fresh[static_cast<std::size_t>(c)] = innovation(noise, run.value, history, t, c);
      for (int a = 0; a < kChannelCount; ++a)
        for (int b = 0; b <= a; ++b)
          if (history(t, a) >= 0 && history(t, b) >= 0) {
            sum(a, b) += fresh[static_cast<std::size_t>(a)] * fresh[static_cast<std::size_t>(b)];
            count(a, b) += 1;
          }
    }
  }
  Covariance covariance = Covariance::Identity();
  for (int a = 0; a < kChannelCount; ++a)
    for (int b = 0; b <= a; ++b)
      if (count(a, b) > kLeastSamples && share_noise(a, b))
        covariance(a, b) = covariance(b, a) = sum(a, b) / count(a, b);
  for (int c = 0; c < kChannelCount; ++c) {
    const auto i = static_cast<std::size_t>(c);
    covariance(c, c) += least_sd[i] * least_sd[i];
  }
  noise.innovation_covariance = made_positive(covariance);
  return noise;
}

NoiseModel white_noise(const std::vector<ResidualRows>& runs,
                       const std::array<double, kChannelCount>& least_sd) {
  NoiseModel noise;
  noise.innovation_covariance.setIdentity();
  for (int c = 0; c < kChannelCount; ++c) {
    const Autocovariance r = autocovariance(runs, c);
    const auto i = static_cast<std::size_t>(c);
    noise.stationary_ratio[i] = 1.0;
    noise.channel_sd[i] = r.count > 0 && r.lag[0] + least_sd[i] > 0 ? size_of(r, least_sd[i]) : 1.0;
    noise.innovation_covariance(c, c) = noise.channel_sd[i] * noise.channel_sd[i];
  }
  return noise;
}

Whitener::Whitener(const NoiseModel& noise, const Presence& present)
    : noise_(noise), history_(history_of(present)) {
  std::map<std::vector<int>, int> known;
  for (Eigen::Index t = 0; t < present.rows(); ++t) {
    std::vector<int> channels;
    for (int c = 0; c < kChannelCount; ++c)
      if (present(t, c)) channels.push_back(c);
    const auto [entry, fresh] = known.try_emplace(channels, static_cast<int>(patterns_.size()));
    if (fresh) {
      const auto m = static_cast<Eigen::Index>(channels.size());
      Eigen::MatrixXd sub(m, m);
      for (Eigen::Index i = 0; i < m; ++i)
        for (Eigen::Index j = 0; j < m; ++j)
          sub(i, j) = noise.innovation_covariance(channels[static_cast<std::size_t>(i)],
                                                  channels[static_cast<std::size_t>(j)]);
      Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(m, m);
      if (m > 0) Eigen::LLT<Eigen::MatrixXd>(sub).matrixL().solveInPlace(inverse);
      patterns_.push_back({channels, inverse});
    }
    pattern_of_sample_.push_back(entry->second);
    channel_of_entry_.insert(channel_of_entry_.end(), channels.begin(), channels.end());
    entries_ += static_cast<Eigen::Index>(channels.size());
  }
}

Eigen::VectorXd Whitener::operator()(const Eigen::MatrixXd& rows) const {
  std::array<bool, kChannelCount> touched{};  // most columns touch one or two channels
  for (Eigen::Index c = 0; c < rows.cols(); ++c)
    touched[static_cast<std::size_t>(c)] = (rows.col(c).array() != 0).any();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(entries_);
  Eigen::Index first = 0;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    const Pattern& pattern =
        patterns_[static_cast<std::size_t>(pattern_of_sample_[static_cast<std::size_t>(t)])];
    const auto m = static_cast<Eigen::Index>(pattern.channels.size());
    for (Eigen::Index j = 0; j < m; ++j) {
      const int channel = pattern.channels[static_cast<std::size_t>(j)];
      if (!touched[static_cast<std::size_t>(channel)]) continue;
      const double fresh = innovation(noise_, rows, history_, t, channel);
      if (fresh == 0) continue;
      const double* const factor = pattern.inverse_factor.data() + j * m;
      for (Eigen::Index i = j; i < m; ++i) result[first + i] += fresh * factor[i];
    }
    first += m;
  }
  return result;
}

}  // namespace joulepath
