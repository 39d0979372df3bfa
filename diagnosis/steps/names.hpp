#pragma once

#include "diagnosis/steps/examination.hpp"

namespace joulepath {

/// The best set's effects, less those that may only make up for the inexact form of a greater one.
void choose_names(Examination& examination);

/// Effects by probability, the dozen likeliest.
void rank_effects(Examination& examination);

}  // namespace joulepath
