#pragma once

#include <ctime>

namespace joulepath::nlp {

/// CPU time (s) of this thread: what other threads and programs take does not count.
inline double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

}  // namespace joulepath::nlp
