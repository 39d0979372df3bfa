#pragma once

#include "planner/nlp/transcription/jerk_program.hpp"

namespace joulepath::nlp {

/// The distance of the program's guess from the optimum.
enum class JerkStart { far, near };

/// solve_fast() for a program under a jerk limit: the same interior-point method; its Newton systems are
/// solved from segment to segment (stage_system.hpp), to 1e-9 of the objective. If it stalls, `converged` is
/// false and `message` contains the reason.
[[nodiscard]] JerkSolution solve_fast(const JerkProgram& program, JerkStart start = JerkStart::far);

}  // namespace joulepath::nlp
