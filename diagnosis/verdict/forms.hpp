#pragma once

#include "diagnosis/verdict/verdict.hpp"

namespace joulepath {

/// A judgment with the names taken back whose law is not the catalog's: two or more laws of one
/// family, which together can draw any curve, and laws that fit only with a strength that depends on
/// something.
[[nodiscard]] Judgment judge_forms(const Examination& examination, Judgment judgment);

}  // namespace joulepath
