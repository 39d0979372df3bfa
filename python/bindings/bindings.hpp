#pragma once

#include <nanobind/nanobind.h>

namespace joulepath::python {

namespace nb = nanobind;

// One function per file of this folder: each adds its part to the module.
void bind_errors(nb::module_& module);
void bind_stop(nb::module_& module);
void bind_arrays(nb::module_& module);
void bind_robot(nb::module_& module);
void bind_plan(nb::module_& module);
void bind_online(nb::module_& module);
void bind_fleet(nb::module_& module);
void bind_routing(nb::module_& module);
void bind_program(nb::module_& module);
void bind_simulation(nb::module_& module);
void bind_diagnosis(nb::module_& module);

}  // namespace joulepath::python
