#pragma once

#include <functional>
#include <random>
#include <vector>

namespace joulepath::ways {

using Objective = std::function<double(const std::vector<double>&)>;

/// Covariance matrix adaptation, the (mu/mu_w, lambda) strategy with rank-one and rank-mu updates
/// [Hansen2016], from `x` with a first step. Sets `x` to the
/// best point and returns its value.
double minimize_by_cma(std::vector<double>& x, double first_step, int evaluations, std::mt19937& random,
                       const Objective& objective);

/// Nelder and Mead's simplex [NelderMead1965] (NLopt) in the same form.
double minimize_by_simplex(std::vector<double>& x, double first_step, int evaluations,
                           const Objective& objective);

}  // namespace joulepath::ways
