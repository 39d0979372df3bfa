#pragma once

namespace joulepath {

/// 97.5 % quantile of Student's t; with less than one degree of freedom that of one.
[[nodiscard]] double student_t_975(double degrees_of_freedom);

}  // namespace joulepath
