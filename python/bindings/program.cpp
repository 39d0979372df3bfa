#include "app/program.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/interrupt.hpp"
#include "python/bindings/bindings.hpp"

namespace joulepath::python {

void bind_program(nb::module_& module) {
  module.def(
      "program_main",
      [](std::vector<std::string> arguments) {
        std::vector<char*> words;
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        const nb::gil_scoped_release release;
        install_signal_handlers();
        return program_main(static_cast<int>(arguments.size()), words.data());
      },
      nb::arg("arguments"),
      "The program `joulepath`; gives its exit code. For a process of its own: it takes Ctrl-C over.");
}

}  // namespace joulepath::python
