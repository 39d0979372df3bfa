#include "app/program.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <unistd.h>

#include <cstdio>

#include "app/interrupt.hpp"
#include "model/progress.hpp"
#include "python/bindings/bindings.hpp"

namespace joulepath::python {

void bind_program(nb::module_& module) {
  module.def(
      "program_main",
      [](std::vector<std::string> arguments, int steps_file) {
        std::vector<char*> words;
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        const nb::gil_scoped_release release;
        install_signal_handlers();
        StepCount steps(
            [=](std::size_t done, std::size_t total) { dprintf(steps_file, "%zu %zu\n", done, total); });
        const StepScope scope(steps_file >= 0 ? &steps : nullptr);
        const int code = program_main(static_cast<int>(arguments.size()), words.data());
        if (code == 0 && steps_file >= 0) steps.finish();
        return code;
      },
      nb::arg("arguments"), nb::arg("steps_file") = -1,
      "The program `joulepath`; gives its exit code. For a process of its own: it takes Ctrl-C over. "
      "`steps_file`: descriptor of the file that gets a line `done total` for each step.");
}

}  // namespace joulepath::python
