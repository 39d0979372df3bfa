#include "planner/path/geometry/arc_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/path/geometry/quadrature.hpp"

namespace joulepath {
namespace {

using Values = ArcCell::Values;
constexpr std::size_t kPoints = ArcCell::kPoints;

/// Chebyshev points on [0, 1], both ends included, and the integrals from 0 to each of them of the Lagrange
/// polynomials through them.
struct ArcRule {
  Values place{};
  std::array<Values, kPoints> weight{};  ///< [polynomial][end of the integral]

  ArcRule() {
    for (std::size_t i = 0; i < kPoints; ++i)
      place[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) / (kPoints - 1));
    order();
    for (std::size_t j = 0; j < kPoints; ++j)
      for (std::size_t i = 1; i < kPoints; ++i)
        weight[j][i] = integrate_gauss8([&](double x) { return lagrange(j, x); }, 0, place[i]);
  }

  double lagrange(std::size_t j, double x) const {
    double product = 1;
    for (std::size_t i = 0; i < kPoints; ++i)
      if (i != j) product *= (x - place[i]) / (place[j] - place[i]);
    return product;
  }

  /// Leja's order: 0, 1, then always the point with the largest product of distances to those before.
  void order() {
    std::swap(place[1], place[kPoints - 1]);
    for (std::size_t k = 2; k < kPoints; ++k) {
      const auto distances = [&](double x) {
        double product = 1;
        for (std::size_t i = 0; i < k; ++i) product *= std::abs(x - place[i]);
        return product;
      };
      const auto next = std::max_element(place.begin() + static_cast<std::ptrdiff_t>(k), place.end(),
                                         [&](double a, double b) { return distances(a) < distances(b); });
      std::iter_swap(place.begin() + static_cast<std::ptrdiff_t>(k), next);
    }
  }
};

const ArcRule& arc_rule() {
  static const ArcRule rule;
  return rule;
}

}  // namespace

const Values& ArcCell::places() { return arc_rule().place; }

void ArcCell::integrate(const Values& speed_m) {
  const ArcRule& rule = arc_rule();
  for (std::size_t j = 0; j < kPoints; ++j) {
    const double share_m = (to_t_ - from_t_) * speed_m[j];
    for (std::size_t i = 0; i < kPoints; ++i) arc_m_[i] += rule.weight[j][i] * share_m;
  }
}

void ArcCell::invert() {
  const Values& place = places();
  for (std::size_t i = 0; i < kPoints; ++i) divided_[i] = place[i] * (to_t_ - from_t_);
  for (std::size_t k = 1; k < kPoints; ++k)
    for (std::size_t i = kPoints; i-- > k;)
      divided_[i] = (divided_[i] - divided_[i - 1]) / (arc_m_[i] - arc_m_[i - k]);
}

double ArcCell::parameter(double arc_m) const {
  double since_from = divided_[kPoints - 1];
  for (std::size_t k = kPoints - 1; k-- > 0;) since_from = divided_[k] + (arc_m - arc_m_[k]) * since_from;
  return std::clamp(from_t_ + since_from, from_t_, to_t_);
}

ArcCell::Place ArcCell::place(double arc_m) const {
  Place place{divided_[kPoints - 1], 0};
  for (std::size_t k = kPoints - 1; k-- > 0;) {
    place.t_per_m = place.t + (arc_m - arc_m_[k]) * place.t_per_m;
    place.t = divided_[k] + (arc_m - arc_m_[k]) * place.t;
  }
  place.t += from_t_;
  return place;
}

}  // namespace joulepath
