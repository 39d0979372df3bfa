#pragma once

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/interval/segment.hpp"

namespace joulepath::nlp {

/// Determines the wheels' coefficients from the model at a place. Returns false if the model is not affine in
/// (a, b, u) there, because an effect's law is nonlinear; derivatives then include the effect.
[[nodiscard]] bool fit_affine(const Plant& plant, const PathRates& rates, const Site& site,
                              Sided<AffineWheel>& wheel);

}  // namespace joulepath::nlp
