// The bordered Newton system against a dense one that is written from its definition.
#include "planner/joint/bordered_system.hpp"

#include <gtest/gtest.h>

#include <random>

namespace joulepath::joint {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index kSquares = 3, kParameters = 6, kErrors = 2;

class Drawn {
 public:
  double number() { return uniform_(engine_); }
  MatrixXd matrix(Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return number(); });
  }
  /// Symmetric and positive definite.
  MatrixXd metric(Index size) {
    const MatrixXd root = matrix(size, size);
    return root * root.transpose() + MatrixXd::Identity(size, size);
  }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// Four parts in a row on two pieces, at rest at both ends, and the same system as dense matrices: squares
/// first.
struct TwoPieces {
  TwoPieces() {
    const std::vector<BorderedSystem::Part> parts{
        {{-1, 0}, {0, 1, 4}}, {{0, 1}, {0, 1, 4}}, {{1, 2}, {1, 2, 5}}, {{2, -1}, {1, 2, 5}}};
    system = BorderedSystem(parts, kSquares, kParameters);
    system.clear();
    for (int times = 0; times < 2; ++times)  // a part and its rows
      for (std::size_t k = 0; k < parts.size(); ++k) add(k, parts[k]);
    for (Index at = 0; at < kParameters; ++at) add_bound(false, at);  // the knot 3 has no part
    for (Index at = 0; at < kSquares; ++at) add_bound(true, at);
    system.targets = draw.matrix(kErrors, kParameters);
    system.errors = draw.matrix(kErrors, 1);
    system.metric = draw.metric(kParameters);
  }

  void add(std::size_t k, const BorderedSystem::Part& part) {
    const MatrixXd hessian = draw.metric(5);
    std::array<double, 15> triangle{};
    std::array<double, 5> of_g{}, of_lagrangian{};
    std::array<Index, 5> at{part.squares[0], part.squares[1]};
    for (std::size_t i = 0; i < 3; ++i) at[2 + i] = kSquares + part.parameters[i];
    for (std::size_t i = 0, entry = 0; i < 5; ++i) {
      of_g[i] = draw.number();
      if (at[i] >= 0) g[at[i]] += of_g[i];
      for (std::size_t n = 0; n < 5; ++n) {
        const double h = hessian(static_cast<Index>(i), static_cast<Index>(n));
        if (n <= i) triangle[entry++] = h;
        if (at[i] >= 0 && at[n] >= 0) dense(at[i], at[n]) += h;
      }
    }
    system.add(k, of_g, of_lagrangian, triangle);
  }

  void add_bound(bool of_square, Index at) {
    const double slope = draw.number(), bend = 3 + draw.number();
    system.add_bound(of_square, at, slope, 0, bend);
    const Index unknown = of_square ? at : kSquares + at;
    g[unknown] += slope;
    dense(unknown, unknown) += bend;
  }

  Drawn draw{};
  BorderedSystem system{};
  MatrixXd dense = MatrixXd::Zero(kSquares + kParameters, kSquares + kParameters);
  VectorXd g = VectorXd::Zero(kSquares + kParameters);
};

/// [T B; B' H] step + A' multipliers + the metric's share = -g, and A step = -errors.
TEST(BorderedSystem, SolvesTheDenseSystem) {
  TwoPieces made;
  BorderedSystem& system = made.system;
  constexpr double kWeight = 0.3;
  system.solve(kWeight);
  system.follow();
  const VectorXd shortest =
      system.targets.transpose() * (system.targets * system.targets.transpose()).inverse() * -system.errors;
  VectorXd step(kSquares + kParameters);
  step << system.step.squares, system.step.parameters;
  VectorXd residual = made.dense * step + made.g;
  residual.tail(kParameters) += kWeight * system.metric * (system.step.parameters - shortest) +
                                system.targets.transpose() * system.multipliers;
  EXPECT_LT(residual.norm(), 1e-10);
  EXPECT_LT((system.targets * system.step.parameters + system.errors).norm(), 1e-12);
}

TEST(BorderedSystem, TakesTheShortestStepToTheTargets) {
  TwoPieces made;
  made.system.solve(0.1);
  const VectorXd change = made.draw.matrix(kErrors, 1);
  const VectorXd step = made.system.to_targets(change);
  EXPECT_LT((made.system.targets * step - change).norm(), 1e-12);
  const VectorXd in_null = made.system.targets.fullPivLu().kernel().transpose() * step;
  EXPECT_LT(in_null.norm(), 1e-12);
}

/// Held parameters do not move; the others move as if those did not exist.
TEST(BorderedSystem, HeldParametersAreOutOfTheSystem) {
  TwoPieces made, changed;
  for (TwoPieces* each : {&made, &changed}) {
    if (each == &changed) each->system.g.parameters[0] += 5;
    each->system.hold({0});
    each->system.solve(0.2);
    each->system.follow();
    EXPECT_NEAR(each->system.step.parameters[0], 0, 1e-12);
  }
  EXPECT_LT((made.system.step.parameters - changed.system.step.parameters).norm(), 1e-12);
  EXPECT_LT((made.system.step.squares - changed.system.step.squares).norm(), 1e-12);
}

}  // namespace
}  // namespace joulepath::joint
