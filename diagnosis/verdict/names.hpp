#pragma once

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// Share of the best set's gain in loss that is lost when one of its effects is left out.
[[nodiscard]] double gain_share_of(const Examination& examination, const std::string& label);

/// The best set's effects, less those that may only make up for the inexact form of a greater one.
void choose_names(Examination& examination);

/// Effects by probability, the dozen likeliest.
void rank_effects(Examination& examination);

}  // namespace joulepath
