#pragma once

#include <array>

namespace joulepath {

/// Integral of f over [a, b] by the 8-point Gauss-Legendre rule (exact for polynomials of degree 15).
template <class Function>
double integrate_gauss8(const Function& f, double a, double b) {
  constexpr std::array<double, 4> x{0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                                    0.96028985649753623168};
  constexpr std::array<double, 4> w{0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                                    0.10122853629037625915};
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += w[i] * (f(middle - half * x[i]) + f(middle + half * x[i]));
  return half * sum;
}

}  // namespace joulepath
