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
  double low = 1e-12, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double share = std::sqrt(low * high);
    (duration_of(problem, blend(envelope, share)) > duration_s ? low : high) = share;
  }
  return blend(envelope, std::min(high, 0.9999));
}

}  // namespace joulepath
