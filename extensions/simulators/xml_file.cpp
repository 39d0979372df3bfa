#include "extensions/simulators/xml_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenarios/text/document.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

/// The element whose tag comes before; null: none.
const tinyxml2::XMLElement* previous_tag(const tinyxml2::XMLElement* element) {
  const auto* beside = element->PreviousSiblingElement();
  if (!beside) return element->Parent()->ToElement();
  while (beside->LastChildElement()) beside = beside->LastChildElement();
  return beside;
}

const tinyxml2::XMLElement* next_tag(const tinyxml2::XMLElement* element) {
  if (element->FirstChildElement()) return element->FirstChildElement();
  while (element && !element->NextSiblingElement()) element = element->Parent()->ToElement();
  return element ? element->NextSiblingElement() : nullptr;
}

}  // namespace

std::optional<XmlElement> XmlElement::find(const char* child) const {
  const tinyxml2::XMLElement* found = element_->FirstChildElement(child);
  return found ? std::optional(XmlElement(found, file_)) : std::nullopt;
}

std::vector<XmlElement> XmlElement::children(const char* name) const {
  std::vector<XmlElement> all;
  for (const auto* child = element_->FirstChildElement(name); child; child = child->NextSiblingElement(name))
    all.emplace_back(child, file_);
  return all;
}

std::vector<XmlElement> XmlElement::descendants(const char* name) const {
  std::vector<XmlElement> all;
  for (const XmlElement& child : children()) {
    if (child.name() == name) all.push_back(child);
    for (const XmlElement& below : child.descendants(name)) all.push_back(below);
  }
  return all;
}

std::optional<XmlElement> XmlElement::parent() const {
  const auto* above = element_->Parent() ? element_->Parent()->ToElement() : nullptr;
  return above ? std::optional(XmlElement(above, file_)) : std::nullopt;
}

std::optional<std::string> XmlElement::attribute(const char* name) const {
  const char* value = element_->Attribute(name);
  return value ? std::optional<std::string>(value) : std::nullopt;
}

std::string XmlElement::required(const char* name) const {
  const auto value = attribute(name);
  if (!value) fail("no attribute " + std::string(name), "<" + this->name() + " " + name + "=...>");
  return *value;
}

std::string XmlElement::text() const {
  std::istringstream words(element_->GetText() ? element_->GetText() : "");
  std::string all;
  for (std::string word; words >> word;) all += (all.empty() ? "" : " ") + word;
  return all;
}

std::vector<double> XmlElement::numbers(const std::string& text, std::size_t count) const {
  std::vector<double> values;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto value = parse_number(word);
    if (!value) fail(joulepath::quoted(text), "numbers separated by blanks");
    values.push_back(*value);
  }
  if (count > 0 && values.size() != count)
    fail(std::to_string(values.size()) + " numbers", std::to_string(count) + " numbers");
  return values;
}

Eigen::Vector3d XmlElement::vector(const std::string& text) const {
  return Eigen::Vector3d(numbers(text, 3).data());
}

std::optional<double> XmlElement::number_at(const char* attribute_name) const {
  const auto value = attribute(attribute_name);
  return value ? std::optional(number(*value)) : std::nullopt;
}

std::optional<double> XmlElement::number_in(const char* child) const {
  const auto below = find(child);
  return below ? std::optional(below->number(below->text())) : std::nullopt;
}

void XmlElement::fail(std::string found, std::string accepted, std::string hint) const {
  std::string key = "<" + name();
  if (const auto called = attribute("name")) key += " name=" + joulepath::quoted(*called);
  throw ConfigError({{*file_, line(), 1}, key + ">", std::move(found), std::move(accepted), std::move(hint)});
}

std::string XmlElement::place() const {
  return std::filesystem::path(*file_).filename().string() + " line " + std::to_string(line());
}

std::size_t XmlElement::index() const {
  std::size_t before = 0;
  for (const tinyxml2::XMLElement* at = element_; (at = previous_tag(at)) != nullptr;) ++before;
  return before;
}

XmlFile::XmlFile(const std::string& file) : XmlFile(file, read_text_file(file)) {}

XmlElement XmlFile::element(std::size_t index) const {
  const tinyxml2::XMLElement* at = document_->RootElement();
  while (index-- > 0) at = next_tag(at);
  return {at, file_.get()};
}

XmlFile::XmlFile(const std::string& file, const std::string& text)
    : file_(std::make_unique<const std::string>(file)), document_(std::make_unique<tinyxml2::XMLDocument>()) {
  document_->Parse(text.data(), text.size());
  if (document_->Error() || document_->RootElement() == nullptr)
    throw ConfigError(
        {{file, document_->ErrorLineNum(), 1},
         "",
         document_->Error() ? std::string("broken XML: ") + document_->ErrorName() : "no element",
         "an XML file",
         ""});
}

bool is_xml(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;  // a pipe may have no writer
  std::ifstream in(file, std::ios::binary);
  char first = ' ';
  while (in.get(first) && (first == ' ' || first == '\n' || first == '\r' || first == '\t' ||
                           first == '\xEF' || first == '\xBB' || first == '\xBF')) {
  }
  return in && first == '<';
}

}  // namespace joulepath
