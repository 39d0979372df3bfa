#pragma once

#include <nanobind/nanobind.h>

#include <atomic>

#include "model/stop.hpp"

namespace joulepath::python {

/// Lets a waiting caller end the computations of the threads that use it.
struct StopToken {
  std::atomic<bool> set{false};
};

/// Calls a long computation without the GIL. A signal handler that raises (Ctrl-C: KeyboardInterrupt), or the
/// thread's StopToken, ends it at its next step.
class LongCall {
 public:
  LongCall();

 private:
  nanobind::gil_scoped_release release_{};
  StopScope stop_;
};

}  // namespace joulepath::python
