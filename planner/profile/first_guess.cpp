#include "planner/profile/first_guess.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {

std::vector<double> blend(const nlp::RateEnvelope& envelope, double share) {
  std::vector<double> b(envelope.fastest.size());
  for (std::size_t k = 0; k < b.size(); ++k)
    b[k] = share * envelope.fastest[k] + (1 - share) * envelope.slowest[k];
  b.front() = envelope.fastest.front();
  b.back() = envelope.fastest.back();
  return b;
}

std::vector<double> first_guess(const nlp::Problem& problem, const nlp::RateEnvelope& envelope,
                                double duration_s) {
  constexpr double kLeast = 1e-12, kMost = 0.9999;
  const std::vector<double>& slowest = envelope.slowest;
  if (std::all_of(slowest.begin(), slowest.end(), [](double b) { return b == 0; })) {
    // All rates are those of the fastest times the root of the share, from rest to rest.
    const double root = duration_of(problem, envelope.fastest) / duration_s;
    return blend(envelope, std::clamp(root * root, kLeast, kMost));
  }
  double low = kLeast, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double share = std::sqrt(low * high);
    (duration_of(problem, blend(envelope, share)) > duration_s ? low : high) = share;
  }
  return blend(envelope, std::min(high, kMost));
}

}  // namespace joulepath
