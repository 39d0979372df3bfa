#include "python/bindings/stop.hpp"

#include <chrono>

#include "python/bindings/bindings.hpp"

namespace joulepath::python {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kBetweenChecks{20};

thread_local StopToken* token = nullptr;  // the waiting thread keeps it alive

void raise_interrupt() {
  const nb::gil_scoped_acquire acquire;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw nb::python_error();
}

void raise_pending_signal() {
  const nb::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

}  // namespace

LongCall::LongCall()
    : stop_([last = Clock::now()]() mutable {
        if (token != nullptr && token->set) raise_interrupt();
        if (Clock::now() - last < kBetweenChecks) return;
        raise_pending_signal();
        last = Clock::now();
      }) {}

void bind_stop(nb::module_& module) {
  nb::class_<StopToken>(module, "StopToken", "Ends the computations of the threads that use it.")
      .def(nb::init<>())
      .def("stop", [](StopToken& self) { self.set = true; });
  module.def(
      "use_stop_token", [](StopToken* used) { token = used; }, nb::arg("token").none(),
      "Ends this thread's computations when the token is set; the token must outlive them.");
}

}  // namespace joulepath::python
