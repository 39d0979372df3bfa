#include "benchmarks/ways/cma_es.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlopt.hpp>

namespace joulepath::ways {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr double kSmallestStep = 1e-5;

struct Trial {
  Vector step{};  ///< from the mean, in units of sigma
  double value{};
};

/// Constants of the strategy for n variables.
struct Rates {
  explicit Rates(double n) : lambda(4 + static_cast<int>(3 * std::log(n))), weight(Vector(lambda / 2)) {
    for (int i = 0; i < weight.size(); ++i) weight[i] = std::log(0.5 * (lambda + 1)) - std::log(i + 1.0);
    weight /= weight.sum();
    mu = 1 / weight.squaredNorm();
    c_sigma = (mu + 2) / (n + mu + 5);
    damping = 1 + 2 * std::max(0.0, std::sqrt((mu - 1) / (n + 1)) - 1) + c_sigma;
    c_c = (4 + mu / n) / (n + 4 + 2 * mu / n);
    c_1 = 2 / ((n + 1.3) * (n + 1.3) + mu);
    c_mu = std::min(1 - c_1, 2 * (mu - 2 + 1 / mu) / ((n + 2) * (n + 2) + mu));
    norm = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  }
  int lambda{};
  Vector weight{};
  double mu{}, c_sigma{}, damping{}, c_c{}, c_1{}, c_mu{}, norm{};
};

class Strategy {
 public:
  Strategy(const std::vector<double>& x, double sigma)
      : n_(static_cast<Eigen::Index>(x.size())),
        rates_(static_cast<double>(n_)),
        mean_(Eigen::Map<const Vector>(x.data(), n_)),
        path_sigma_(Vector::Zero(n_)),
        path_c_(Vector::Zero(n_)),
        covariance_(Matrix::Identity(n_, n_)),
        sigma_(sigma) {}

  bool is_done() const { return sigma_ * std::sqrt(covariance_.diagonal().maxCoeff()) < kSmallestStep; }
  int population() const { return rates_.lambda; }

  /// One generation; `evaluate` sees each point.
  void step(std::mt19937& random, const std::function<double(const Vector&)>& evaluate) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(covariance_);
    const Vector scale = eigen.eigenvalues().cwiseMax(1e-20).cwiseSqrt();
    const Matrix& axes = eigen.eigenvectors();
    std::normal_distribution<> normal;
    std::vector<Trial> trials(static_cast<std::size_t>(rates_.lambda));
    for (Trial& trial : trials) {
      Vector z(n_);
      for (double& value : z) value = normal(random);
      trial.step = axes * scale.cwiseProduct(z);
      trial.value = evaluate(mean_ + sigma_ * trial.step);
    }
    std::stable_sort(trials.begin(), trials.end(),
                     [](const Trial& a, const Trial& b) { return a.value < b.value; });
    adapt(trials, axes * scale.cwiseInverse().asDiagonal() * axes.transpose());
  }

 private:
  void adapt(const std::vector<Trial>& trials, const Matrix& whitening) {
    Vector mean_step = Vector::Zero(n_);
    Matrix spread = Matrix::Zero(n_, n_);
    for (Eigen::Index i = 0; i < rates_.weight.size(); ++i) {
      const Vector& y = trials[static_cast<std::size_t>(i)].step;
      mean_step += rates_.weight[i] * y;
      spread += rates_.weight[i] * y * y.transpose();
    }
    mean_ += sigma_ * mean_step;
    const double c = rates_.c_sigma;
    path_sigma_ = (1 - c) * path_sigma_ + std::sqrt(c * (2 - c) * rates_.mu) * whitening * mean_step;
    const bool stalled = path_sigma_.norm() > (1.4 + 2.0 / static_cast<double>(n_ + 1)) * rates_.norm * 1.5;
    path_c_ *= 1 - rates_.c_c;
    if (!stalled) path_c_ += std::sqrt(rates_.c_c * (2 - rates_.c_c) * rates_.mu) * mean_step;
    covariance_ = (1 - rates_.c_1 - rates_.c_mu) * covariance_ + rates_.c_1 * path_c_ * path_c_.transpose() +
                  rates_.c_mu * spread;
    sigma_ *= std::exp(c / rates_.damping * (path_sigma_.norm() / rates_.norm - 1));
  }

  Eigen::Index n_{};
  Rates rates_;
  Vector mean_{}, path_sigma_{}, path_c_{};
  Matrix covariance_{};
  double sigma_{};
};

}  // namespace

double minimize_by_cma(std::vector<double>& x, double first_step, int evaluations, std::mt19937& random,
                       const Objective& objective) {
  Strategy strategy(x, first_step);
  double best = objective(x);
  for (int used = 1; used < evaluations && !strategy.is_done(); used += strategy.population())
    strategy.step(random, [&](const Vector& at) {
      const std::vector<double> point(at.data(), at.data() + at.size());
      const double value = objective(point);
      if (value < best) best = value, x = point;
      return value;
    });
  return best;
}

double minimize_by_simplex(std::vector<double>& x, double first_step, int evaluations,
                           const Objective& objective) {
  nlopt::opt optimizer(nlopt::LN_NELDERMEAD, static_cast<unsigned>(x.size()));
  optimizer.set_initial_step(first_step);
  optimizer.set_ftol_rel(1e-8);
  optimizer.set_maxeval(evaluations);
  Objective copy = objective;
  optimizer.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                 void* function) { return (*static_cast<Objective*>(function))(at); },
                              &copy);
  double value = 0;
  optimizer.optimize(x, value);
  return value;
}

}  // namespace joulepath::ways
