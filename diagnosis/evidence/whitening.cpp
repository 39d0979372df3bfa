#include "diagnosis/evidence/whitening.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0502-noise-and-scatter.md
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
  Autocovariances lag{};
  double count{};
};

/// The channels whose noise is one: that of both positions, whatever their axes are.
std::vector<int> alike(int channel) {
  if (channel == kPositionX || channel == kPositionY) return {kPositionX, kPositionY};
  return {channel};
}

void add_products_over_time(const std::vector<ResidualRows>& runs, int channel, Autocovariance& sum,
                            Autocovariances& counts) {
  for (const ResidualRows& run : runs)
    for (Eigen::Index t = 0; t < run.value.rows(); ++t)
      for (int k = 0; k <= kAutoregressionOrder && k <= t; ++k) {
        if (!run.present(t, channel) || !run.present(t - k, channel)) break;
        sum.lag[static_cast<std::size_t>(k)] += run.value(t, channel) * run.value(t - k, channel);
        counts[static_cast<std::size_t>(k)] += 1;
      }
}

Autocovariance autocovariance(const std::vector<ResidualRows>& runs, int channel) {
  Autocovariance sum;
  Autocovariances counts{};
  for (const int one : alike(channel)) add_products_over_time(runs, one, sum, counts);
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0) sum.lag[k] /= counts[k];
  sum.count = counts[0];
  return sum;
}

/// Standard deviation of a channel's noise, 1 without data.
double size_of(const Autocovariance& r, double least_sd) {
  return r.count > 0 ? std::hypot(std::sqrt(r.lag[0]), least_sd) : 1.0;
}

/// One channel, or both that are alike, of all runs that have a row of it.
std::vector<ChannelOfRun> runs_with(const std::vector<ResidualRows>& runs, int channel) {
  std::vector<ChannelOfRun> list;
  for (const int one : alike(channel))
    for (const ResidualRows& run : runs)
      if (run.present.col(one).any()) list.push_back({run.value.col(one), run.present.col(one).array()});
  return list;
}

void fit_channel(NoiseModel& noise, int channel, const std::vector<ResidualRows>& runs, double least_sd) {
  const Autocovariance r = autocovariance(runs, channel);
  const auto c = static_cast<std::size_t>(channel);
  noise.channel_sd[c] = size_of(r, least_sd);
  if (r.count >= kLeastSamples && r.lag[0] > 0) noise.memory[c] = fit_autoregression(r.lag);
  if (channel >= kHeading) noise.walk[c] = estimate_walk(runs_with(runs, channel));
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

/// Adds the products of the innovations of each two channels, and their number.
void add_products(const NoiseModel& noise, const ResidualRows& run, Covariance& sum, Covariance& count) {
  const Innovations innovations(noise, run.present);
  Eigen::MatrixXd fresh(run.value.rows(), kChannelCount);
  for (int c = 0; c < kChannelCount; ++c) fresh.col(c) = innovations(run.value, c);
  const Eigen::MatrixXd present = run.present.cast<double>();
  sum += fresh.transpose() * fresh;
  count += present.transpose() * present;
}

}  // namespace

NoiseModel estimate_noise(const std::vector<ResidualRows>& runs,
                          const std::array<double, kChannelCount>& least_sd) {
  NoiseModel noise;
  for (int c = 0; c < kChannelCount; ++c) fit_channel(noise, c, runs, least_sd[static_cast<std::size_t>(c)]);
  Covariance sum = Covariance::Zero(), count = Covariance::Zero();
  for (const ResidualRows& run : runs) add_products(noise, run, sum, count);
  Covariance covariance = Covariance::Identity();
  for (int c = 0; c < kHeading; ++c)  // too few rows for a memory
    covariance(c, c) = std::pow(noise.channel_sd[static_cast<std::size_t>(c)], 2);
  for (int a = 0; a < kChannelCount; ++a)
    for (int b = 0; b <= a; ++b)
      if (count(a, b) > kLeastSamples && share_noise(a, b))
        covariance(a, b) = covariance(b, a) = sum(a, b) / count(a, b);
  if (count(kPositionX, kPositionX) > kLeastSamples)
    covariance(kPositionX, kPositionX) = covariance(kPositionY, kPositionY) =
        0.5 * (covariance(kPositionX, kPositionX) + covariance(kPositionY, kPositionY));
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
    noise.channel_sd[i] = r.count > 0 && r.lag[0] + least_sd[i] > 0 ? size_of(r, least_sd[i]) : 1.0;
    noise.innovation_covariance(c, c) = noise.channel_sd[i] * noise.channel_sd[i];
  }
  return noise;
}

Innovations::Innovations(const NoiseModel& noise, const Presence& present)
    : memory_(noise.memory), history_(history_of(present)) {
  for (Eigen::Index c = 0; c < present.cols(); ++c) {
    const WalkNoise& walk = noise.walk[static_cast<std::size_t>(c)];
    if (walk.step_variance > 0 && present.col(c).any())
      walk_[static_cast<std::size_t>(c)].emplace(walk, present.col(c).array());
  }
}

Eigen::VectorXd Innovations::operator()(const Eigen::MatrixXd& rows, int channel) const {
  const auto c = static_cast<std::size_t>(channel);
  if (walk_[c]) return walk_[c]->innovations(rows.col(channel));
  Eigen::VectorXd result = rows.col(channel);
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    if (history_(t, channel) < 0)
      result[t] = 0;
    else if (history_(t, channel) < kAutoregressionOrder)
      result[t] *= memory_[c].innovation_ratio;
    else
      for (int k = 1; k <= kAutoregressionOrder; ++k)
        result[t] -= memory_[c].coefficient[static_cast<std::size_t>(k - 1)] * rows(t - k, channel);
  }
  return result;
}

Whitener::Whitener(const NoiseModel& noise, const Presence& present) : innovations_(noise, present) {
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
  std::array<Eigen::VectorXd, kChannelCount> innovations{};  // most columns touch one or two channels
  for (int c = 0; c < kChannelCount; ++c)
    if ((rows.col(c).array() != 0).any()) innovations[static_cast<std::size_t>(c)] = innovations_(rows, c);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(entries_);
  Eigen::Index first = 0;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    const Pattern& pattern =
        patterns_[static_cast<std::size_t>(pattern_of_sample_[static_cast<std::size_t>(t)])];
    const auto m = static_cast<Eigen::Index>(pattern.channels.size());
    for (Eigen::Index j = 0; j < m; ++j) {
      const Eigen::VectorXd& of_channel =
          innovations[static_cast<std::size_t>(pattern.channels[static_cast<std::size_t>(j)])];
      if (of_channel.size() == 0 || of_channel[t] == 0) continue;
      const double* const factor = pattern.inverse_factor.data() + j * m;
      for (Eigen::Index i = j; i < m; ++i) result[first + i] += of_channel[t] * factor[i];
    }
    first += m;
  }
  return result;
}

}  // namespace joulepath
