#include "python/bindings/arrays.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <iterator>

#include "python/bindings/bindings.hpp"
#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"

namespace joulepath::python {

std::vector<double> vector_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

nb::ndarray<nb::numpy, const double, nb::ndim<1>> view_of(const std::vector<double>& values,
                                                          nb::handle owner) {
  return {values.data(), {values.size()}, owner};
}

void bind_arrays(nb::module_& module) {
  module.def("greatest_size", &greatest_size, nb::arg("key"),
             "The greatest size of a number whose name ends in this unit.");
  module.def(
      "log_column_names",
      [] {
        std::vector<std::string> names(std::begin(kOrientationColumns), std::end(kOrientationColumns));
        for (const LogColumn& column : log_columns())
          if (column.measured) names.push_back(column.name);
        return names;
      },
      "Names of the columns that a run log may have.");
  nb::class_<Log>(module, "Log", "Samples over time; absent channels are empty.")
      .def(
          "columns",
          [](Log& self) {
            std::vector<std::string> names;
            for (const LogColumn& column : log_columns())
              if (!column.channel(self.trajectory).empty()) names.push_back(column.name);
            return names;
          },
          "Names of the channels that are present, in the order of a run log's columns.")
      .def(
          "column",
          [](nb::handle_t<Log> self, const std::string& name) {
            const LogColumn* column = find_log_column(name);
            if (column == nullptr) throw nb::key_error(name.c_str());
            return view_of(column->channel(nb::cast<Log&>(self).trajectory), self);
          },
          nb::arg("name"), "A read-only view of a channel.")
      .def(
          "text", [](const Log& self) { return run_log_text(self.trajectory); },
          "The samples as a run log (CSV).");
}

}  // namespace joulepath::python
