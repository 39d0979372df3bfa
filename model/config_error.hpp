#pragma once

#include <stdexcept>
#include <string>

namespace joulepath {

/// A position in a file that a user wrote; line and column count from 1, 0 = unknown.
struct SourceMark {
  std::string file{};
  int line{};
  int column{};
};

/// An error in the input, with what the user needs to correct it. `what()` is the whole message:
/// `file:line:column: key: found X, accepted Y (hint)`.
class ConfigError : public std::runtime_error {
 public:
  struct Detail {
    SourceMark mark{};
    std::string key{};       ///< dotted, as in the file: `limits.speed_m_s`, `legs[2].to`
    std::string found{};     ///< the value in the file
    std::string accepted{};  ///< the accepted values
    std::string hint{};      ///< one sentence, may be empty
  };

  explicit ConfigError(Detail detail) : std::runtime_error(message(detail)), detail_(std::move(detail)) {}

  const Detail& detail() const { return detail_; }

 private:
  static std::string message(const Detail& detail) {
    std::string text = detail.mark.file;
    if (detail.mark.line > 0)
      text += ":" + std::to_string(detail.mark.line) + ":" + std::to_string(detail.mark.column);
    if (!text.empty()) text += ": ";
    if (!detail.key.empty()) text += detail.key + ": ";
    text += "found " + detail.found;
    if (!detail.accepted.empty()) text += ", accepted: " + detail.accepted;
    if (!detail.hint.empty()) text += " (" + detail.hint + ")";
    return text;
  }

  Detail detail_;
};

}  // namespace joulepath
