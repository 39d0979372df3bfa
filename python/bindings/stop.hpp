#pragma once

#include <nanobind/nanobind.h>

#include <atomic>

#include "model/progress.hpp"
#include "model/stop.hpp"

namespace joulepath::python {

/// Lets a waiting caller end the computations of the threads that use it.
struct StopToken {
  std::atomic<bool> set{false};
};

/// Calls a long computation without the GIL. A signal handler that raises (Ctrl-C: KeyboardInterrupt), the
/// thread's StopToken or `progress` ends it at its next step. `progress(done, total)` is called on the
/// caller's thread alone; it must outlive the call.
class LongCall {
 public:
  explicit LongCall(nanobind::handle progress = {});
  /// The computation is done.
  void finish() { steps_.finish(); }

 private:
  nanobind::gil_scoped_release release_{};
  StopScope stop_;
  StepCount steps_;
  StepScope scope_;
};

}  // namespace joulepath::python
