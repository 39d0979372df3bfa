#include <nanobind/stl/string.h>

#include "app/command.hpp"
#include "model/config_error.hpp"
#include "model/printable.hpp"
#include "python/bindings/bindings.hpp"

namespace joulepath::python {
namespace {

nb::object optional_number(int number) { return number > 0 ? nb::cast(number) : nb::none(); }

/// Raises joulepath.ConfigError with the parts of a ConfigError.
void raise_config_error(const ConfigError& error) {
  const ConfigError::Detail& d = error.detail();
  const nb::object type = nb::module_::import_("joulepath._errors").attr("ConfigError");
  const nb::object raised =
      type(printable(error.what()), printable(d.mark.file), optional_number(d.mark.line),
           optional_number(d.mark.column), printable(d.key), printable(d.found), printable(d.accepted),
           printable(d.hint));
  PyErr_SetObject(type.ptr(), raised.ptr());
}

}  // namespace

void bind_errors(nb::module_&) {
  nb::register_exception_translator([](const std::exception_ptr& raised, void*) {
    try {
      std::rethrow_exception(raised);
    } catch (const ConfigError& error) {
      raise_config_error(error);
    } catch (const EnvironmentError& error) {
      PyErr_SetString(PyExc_OSError, printable(error.what()).c_str());
    }
  });
}

}  // namespace joulepath::python
