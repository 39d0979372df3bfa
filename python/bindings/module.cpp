#include "python/bindings/bindings.hpp"

namespace {

NB_MODULE(_core, module) {
  module.doc() = "Compiled functions of the package joulepath; not a public interface.";
  module.attr("version") = JOULEPATH_VERSION;
  using namespace joulepath::python;
  bind_errors(module);
  bind_stop(module);
  bind_arrays(module);
  bind_robot(module);
  bind_plan(module);
  bind_online(module);
  bind_fleet(module);
  bind_routing(module);
  bind_program(module);
  bind_simulation(module);
  bind_diagnosis(module);
}

}  // namespace
