#pragma once

#include <cstddef>
#include <vector>

#include "case.hpp"

namespace blind {

using Vector = std::vector<double>;
using Matrix = std::vector<Vector>;

inline constexpr Discretization kSmooth{1e-3, false};

/// Machine and world of a case with some of its effects, or with others.
struct Scene {
  Machine machine{};
  World world{};
};

/// One run's directions in whitened signals: calibration nuisances (per sigma), the run's own scatter.
struct RunDirections {
  std::vector<Vector> nuisance, scatter;
};

/// The calibrated machine with these of the case's effects.
[[nodiscard]] Scene scene_with(const Case& c, const std::vector<std::size_t>& which);
/// The scene with a calibration error, one number of sigmas per nuisance.
[[nodiscard]] Scene shifted(Scene scene, const Vector& sigmas);

/// A run's noise-free channels divided by their noise, AR(1) channels as innovations: white, unit variance.
[[nodiscard]] Vector simulate(const Case& c, const Scene& scene, std::size_t run,
                              const Discretization& steps = kSmooth);
[[nodiscard]] RunDirections directions_of(const Case& c, const Scene& scene, std::size_t run);

/// scale (a - b)
[[nodiscard]] Vector difference(const Vector& a, const Vector& b, double scale);
[[nodiscard]] Matrix gram_of(const std::vector<Vector>& directions);
/// Marginalize the last `count` directions of a Gram matrix (with this prior precision each): Schur
/// complement, one direction after the other.
[[nodiscard]] Matrix marginalized(Matrix gram, std::size_t count, double prior);

}  // namespace blind
