#include "python/bindings/robot.hpp"

#include <nanobind/stl/string.h>

#include "app/starter_files.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/errors.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath::python {
namespace {

nb::object number_or_text(const std::string& text) {
  if (text == "true" || text == "false") return nb::bool_(text == "true");
  const std::optional<double> number = parse_number(text);
  if (!number) return nb::cast(text);
  const bool whole = text.find_first_not_of("+-0123456789") == std::string::npos;
  return whole ? nb::object(nb::cast(static_cast<long>(*number))) : nb::object(nb::cast(*number));
}

/// A parsed value as dict, list, str, int, float, bool or None.
nb::object object_of(const Value& value) {
  switch (value.kind) {
    case Value::Kind::null:
      return nb::none();
    case Value::Kind::scalar:
      return value.quoted ? nb::object(nb::cast(value.text)) : number_or_text(value.text);
    case Value::Kind::list: {
      nb::list items;
      for (const Value& item : value.items) items.append(object_of(item));
      return items;
    }
    case Value::Kind::map: {
      nb::dict entries;
      for (const Value::Entry& entry : value.entries) entries[nb::cast(entry.key)] = object_of(entry.value);
      return entries;
    }
  }
  return nb::none();
}

}  // namespace

void bind_robot(nb::module_& module) {
  nb::class_<RobotValue>(module, "RobotValue", "The content of a robot file.")
      .def(
          "text", [](const RobotValue& self) { return robot_text(self.robot); }, "The robot file (YAML).")
      .def_prop_ro("name", [](const RobotValue& self) { return self.robot.name; });
  module.def(
      "load_robot", [](const std::string& file) { return RobotValue{read_robot(file)}; }, nb::arg("file"));
  module.def(
      "parse_robot",
      [](const std::string& text, const std::string& name) {
        return RobotValue{robot_from(Document::parse(text, name))};
      },
      nb::arg("text"), nb::arg("name"), "The robot of a file's text; `name` stands in error messages.");
  module.def(
      "robot_of_object",
      [](const std::string& json) {
        return from_object("robot", [&] { return RobotValue{robot_from(Document::parse(json, "robot"))}; });
      },
      nb::arg("json"), "The robot of a dict, which comes as JSON; errors name keys, not lines.");
  module.def(
      "parse_document",
      [](const std::string& text, const std::string& name) {
        const Document document = Document::parse(text, name);
        return object_of(document.root().value());
      },
      nb::arg("text"), nb::arg("name"), "The values of a YAML or JSON text.");
  module.def(
      "load_document", [](const std::string& file) { return object_of(Document::load(file).root().value()); },
      nb::arg("file"), "The values of a YAML or JSON file.");
  module.def("starter_robot", [] { return std::string(embedded::starter_robot); });
}

}  // namespace joulepath::python
