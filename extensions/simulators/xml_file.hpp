#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace joulepath {

/// An element of an XML file with typed access; its errors name file, line and element.
class XmlElement {
 public:
  XmlElement(const tinyxml2::XMLElement* element, const std::string* file) : element_(element), file_(file) {}

  [[nodiscard]] std::string name() const { return element_->Name(); }
  [[nodiscard]] int line() const { return element_->GetLineNum(); }
  [[nodiscard]] const std::string& file() const { return *file_; }

  [[nodiscard]] std::optional<XmlElement> find(const char* child) const;
  [[nodiscard]] std::vector<XmlElement> children(const char* name = nullptr) const;  ///< null: all
  [[nodiscard]] std::vector<XmlElement> descendants(const char* name) const;
  [[nodiscard]] std::optional<XmlElement> parent() const;

  [[nodiscard]] std::optional<std::string> attribute(const char* name) const;
  [[nodiscard]] std::string required(const char* name) const;  ///< throws ConfigError where it is absent
  [[nodiscard]] std::string text() const;                      ///< without blanks around it

  /// Numbers separated by blanks; throws ConfigError for anything else and for another count (0: any).
  [[nodiscard]] std::vector<double> numbers(const std::string& text, std::size_t count) const;
  [[nodiscard]] double number(const std::string& text) const { return numbers(text, 1).front(); }
  [[nodiscard]] Eigen::Vector3d vector(const std::string& text) const;
  [[nodiscard]] std::optional<double> number_at(const char* attribute_name) const;
  [[nodiscard]] std::optional<double> number_in(const char* child) const;  ///< the text of a child

  [[noreturn]] void fail(std::string found, std::string accepted, std::string hint = {}) const;
  [[nodiscard]] std::string place() const;  ///< "waffle.urdf line 12"
  [[nodiscard]] std::size_t index() const;  ///< among all elements of the file, in the order of their tags

 private:
  const tinyxml2::XMLElement* element_;
  const std::string* file_;
};

/// One parsed file. Throws ConfigError where it cannot be read or is not XML.
class XmlFile {
 public:
  explicit XmlFile(const std::string& file);
  XmlFile(const std::string& file, const std::string& text);  ///< `text` as the content of `file`
  [[nodiscard]] XmlElement root() const { return {document_->RootElement(), file_.get()}; }
  [[nodiscard]] XmlElement element(std::size_t index) const;

 private:
  std::unique_ptr<const std::string> file_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
};

[[nodiscard]] bool is_xml(const std::string& file);

}  // namespace joulepath
