#include "benchmarks/paper/sections.hpp"

#include <cstdarg>
#include <cstdio>

#include "model/assert.hpp"
#include "model/kinematics.hpp"

namespace joulepath::bench {

std::string text(const char* pattern, ...) {
  char buffer[2048];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(buffer, sizeof buffer, pattern, values);
  va_end(values);
  return buffer;
}

const Run& find_run(const Dataset& dataset, double payload_kg, double acceleration_m_s2, double bend) {
  for (const Run& run : dataset.runs) {
    JOULEPATH_ASSERT(run.motion && run.payload.size() == 1,
                     "a run of the paper has a motion and one payload");
    const double end_y_m = run.motion->bezier_m.empty() ? 0.0 : run.motion->bezier_m[0][3][1];
    if (run.payload[0].payload_kg == payload_kg && run.motion->acceleration_m_s2 == acceleration_m_s2 &&
        sign_of(end_y_m) == bend)
      return run;
  }
  throw InternalError(text("no run with %g kg, %g m/s^2, bend %g in %s", payload_kg, acceleration_m_s2, bend,
                           dataset.file.c_str()));
}

}  // namespace joulepath::bench
