#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace joulepath {

/// Offset of the first byte that does not belong to well-formed UTF-8 (RFC 3629); empty when there is none.
[[nodiscard]] std::optional<std::size_t> first_byte_not_utf8(std::string_view text);

/// The text, safe for terminals and JSON writers: control characters (C0, DEL, C1) and bytes that are not
/// UTF-8 appear as their codes (x1b), separators of lines and marks of the direction of writing too (u2028).
[[nodiscard]] std::string printable(std::string_view text);

/// Whether no control character and no mark of the direction of writing moves what is printed after the text.
[[nodiscard]] bool keeps_its_line(std::string_view text);

/// The first control character other than tab, line feed and carriage return, as `U+001B`; empty: none.
[[nodiscard]] std::string first_control_character(std::string_view text);

/// `printable`, cut between two characters to at most `max_bytes` bytes, with `...` at the cut.
[[nodiscard]] std::string printable_start(std::string_view text, std::size_t max_bytes);

/// At most four significant digits, for messages.
[[nodiscard]] std::string four_digits(double value);

}  // namespace joulepath
