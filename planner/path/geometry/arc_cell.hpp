#pragma once

#include <array>
#include <cstddef>

namespace joulepath {

// Design: docs/decisions/0200-paths.md
/// A short part of a curve with parameter t, and t as a polynomial of the arc length on it.
///
/// The speed |B'| is taken at Chebyshev points. The integral of the polynomial through them gives the arc
/// length s at these points (Clenshaw-Curtis quadrature with variable end). The polynomial t(s) through the
/// pairs (s, t) is evaluated in Newton's form, with the points in Leja's order
/// ([Trefethen2013], chapters 5 and 19). Both errors fall geometrically with the number of points where |B'|
/// has no zero near the part.
class ArcCell {
 public:
  static constexpr std::size_t kPoints = 12;
  using Values = std::array<double, kPoints>;

  ArcCell() = default;
  /// `speed_m`: |B'| at a parameter.
  template <class Speed>
  ArcCell(const Speed& speed_m, double from_t, double to_t) : from_t_(from_t), to_t_(to_t) {
    const Values& place = places();
    Values speed;
    for (std::size_t i = 0; i < kPoints; ++i) speed[i] = speed_m(from_t + place[i] * (to_t - from_t));
    integrate(speed);
    invert();
  }

  double length_m() const { return arc_m_[1]; }
  double from_t() const { return from_t_; }
  double to_t() const { return to_t_; }

  /// t at an arc length from the part's start.
  double parameter(double arc_m) const;
  /// The polynomial's slope there as well: 1 / |B'| where the polynomial is exact.
  struct Place {
    double t{};
    double t_per_m{};
  };
  Place place(double arc_m) const;

 private:
  static const Values& places();
  void integrate(const Values& speed_m);
  void invert();

  double from_t_{}, to_t_{};
  Values arc_m_{};    ///< from the start to the points: 0, then the length, then between
  Values divided_{};  ///< differences of t - from_t
};

}  // namespace joulepath
