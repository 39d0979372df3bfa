#pragma once

#include <map>
#include <string>
#include <vector>

namespace joulepath {

/// Changes in the text of an XML file. What they do not touch stays byte for byte.
class XmlEdits {
 public:
  explicit XmlEdits(std::string text);

  /// Elements are counted in the order of their tags (XmlElement::index()). Values are written as they are.
  void set_attribute(std::size_t element, const std::string& name, const std::string& value);
  /// The text of an element without children.
  void set_text(std::size_t element, const std::string& value);
  /// A first child, given as XML.
  void insert_child(std::size_t element, const std::string& child);

  [[nodiscard]] std::string text() const;

 private:
  struct Tag {
    std::size_t begin{}, end{};  ///< of the start tag: `<` and the character after `>`
    bool is_empty{};             ///< `<name/>`
  };
  void replace(std::size_t begin, std::size_t end, std::string with);
  [[nodiscard]] std::string name_of(const Tag& tag) const;

  std::string text_;
  std::vector<Tag> tags_{};
  struct Change {
    std::size_t end{};
    std::string with{};
  };
  std::map<std::size_t, Change> changes_{};  ///< by begin
};

/// Lines that differ, in the unified format, for texts that differ by few lines. Empty: equal texts.
[[nodiscard]] std::string unified_diff(const std::string& before, const std::string& after,
                                       const std::string& name);

}  // namespace joulepath
