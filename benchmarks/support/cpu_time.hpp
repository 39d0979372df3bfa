#pragma once

#include <ctime>

namespace joulepath {

/// CPU time of this process (ms): other load on the machine has little influence.
inline double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

}  // namespace joulepath
