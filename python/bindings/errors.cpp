#include <nanobind/stl/string.h>

#include <cctype>
#include <string_view>
#include <utility>

#include "app/command.hpp"
#include "model/config_error.hpp"
#include "model/printable.hpp"
#include "python/bindings/bindings.hpp"

namespace joulepath::python {
namespace {

/// Options of the command line and the arguments of the package that take their place.
constexpr std::pair<std::string_view, std::string_view> kArguments[] = {
    {"--payload", "payload_kg"}, {"--time", "time_s"}, {"--robot", "robot"}, {"--map", "map"}};

/// A whole word: `--time` is no part of `--time-of-day-s`.
void replace_word(std::string& text, std::string_view word, std::string_view by) {
  const auto goes_on = [&](std::size_t at) {
    return at < text.size() && (text[at] == '-' || std::isalnum(static_cast<unsigned char>(text[at])));
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    if (goes_on(at + word.size())) {
      at += word.size();
      continue;
    }
    text.replace(at, word.size(), by);
    at += by.size();
  }
}

/// The error of an option as that of its argument.
ConfigError of_argument(const ConfigError& error) {
  ConfigError::Detail detail = error.detail();
  for (const auto& [option, argument] : kArguments) {
    if (detail.mark.file == option) {
      detail.mark = {};
      if (detail.key.empty()) detail.key = argument;
    }
    for (std::string* text : {&detail.accepted, &detail.hint})
      replace_word(*text, option, std::string(argument) + "=");
  }
  return ConfigError(detail);
}

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
      raise_config_error(of_argument(error));
    } catch (const UsageError& error) {
      raise_config_error(ConfigError({{}, "without", printable(error.what()), "names of the catalog", ""}));
    } catch (const EnvironmentError& error) {
      PyErr_SetString(PyExc_OSError, printable(error.what()).c_str());
    }
  });
}

}  // namespace joulepath::python
