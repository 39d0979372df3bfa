#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/interval/segment.hpp"

namespace joulepath::nlp {

/// Reads the wheels' coefficients off the model at a place. Returns false where the model is not affine
/// in (a, b, u) there: an effect bends the law, and derivatives have to go through it.
[[nodiscard]] bool fit_affine(const Plant& plant, const PathRates& rates, const Site& site,
                              Sided<AffineWheel>& wheel);

}  // namespace joulepath::nlp
