#include "python/bindings/stop.hpp"

#include <chrono>
#include <thread>

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

StepCount::Report report_to(nb::handle progress) {
  return [progress, caller = std::this_thread::get_id()](std::size_t done, std::size_t total) {
    if (std::this_thread::get_id() != caller) return;
    const nb::gil_scoped_acquire acquire;
    progress(done, total);
  };
}

bool is_given(nb::handle object) { return object.is_valid() && !object.is_none(); }

}  // namespace

LongCall::LongCall(nb::handle progress)
    : stop_([last = Clock::now()]() mutable {
        if (token != nullptr && token->set) raise_interrupt();
        if (Clock::now() - last < kBetweenChecks) return;
        raise_pending_signal();
        last = Clock::now();
      }),
      steps_(report_to(progress)),
      scope_(is_given(progress) ? &steps_ : nullptr) {}

void bind_stop(nb::module_& module) {
  nb::class_<StopToken>(module, "StopToken", "Ends the computations of the threads that use it.")
      .def(nb::init<>())
      .def("stop", [](StopToken& self) { self.set = true; });
  module.def(
      "use_stop_token", [](StopToken* used) { token = used; }, nb::arg("token").none(),
      "Ends this thread's computations when the token is set; the token must outlive them.");
}

}  // namespace joulepath::python
