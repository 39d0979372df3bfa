#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace joulepath {

enum class FieldKind {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  text,
  message
};

struct MessageLayout;

/// One field of a message.
struct MessageField {
  enum class Shape { one, fixed, sequence };
  std::string name{};
  FieldKind kind{};
  Shape shape{Shape::one};
  std::size_t count{};                             ///< of a fixed array
  std::shared_ptr<const MessageLayout> message{};  ///< of kind message
};

/// The fields of a message type, in the order of their bytes.
struct MessageLayout {
  std::vector<MessageField> fields{};
};

/// Bytes of a number of this kind.
[[nodiscard]] std::size_t size_of(FieldKind kind);

/// The layout of a message from its definition (schema encoding ros2msg: the text of its .msg file, followed
/// by those of the types that it uses, each after a line of `=` and `MSG: package/Type`). Null if a type is
/// not defined, contains itself or is nested too deep.
[[nodiscard]] std::shared_ptr<const MessageLayout> layout_of(const std::string& type,
                                                             std::string_view definition);

}  // namespace joulepath
