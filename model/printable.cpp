#include "model/printable.hpp"

#include <cstdint>
#include <cstdio>

namespace joulepath {
namespace {

/// One character of a text: its code point and length in bytes, length 0 where the bytes are not UTF-8.
struct Character {
  std::uint32_t code{};
  std::size_t bytes{};
};

/// Decodes by the ranges of RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF.
Character decode(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0xFFu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3F);
  }
  const std::uint32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  if (code < least || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
  return {code, bytes};
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

/// Line and paragraph separators, and marks that turn the direction of writing [Unicode 15, UAX 9]: they move
/// what is printed after them.
bool is_layout_mark(std::uint32_t code) {
  return code == 0x061C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

bool moves_print(std::uint32_t code) { return is_control(code) || is_layout_mark(code); }

/// The first character of UTF-8 that fits.
template <class Fits>
std::optional<std::uint32_t> first_character(std::string_view text, const Fits& fits) {
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text.substr(at));
    if (character.bytes > 0 && fits(character.code)) return character.code;
    at += character.bytes == 0 ? 1 : character.bytes;
  }
  return std::nullopt;
}

std::string escaped(std::uint32_t value) {
  char text[12];
  std::snprintf(text, sizeof text, value <= 0xFF ? "\\x%02x" : "\\u%04x", static_cast<unsigned>(value));
  return text;
}

}  // namespace

std::optional<std::size_t> first_byte_not_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text.substr(at));
    if (character.bytes == 0) return at;
    at += character.bytes;
  }
  return std::nullopt;
}

std::string printable(std::string_view text) {
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text.substr(at));
    if (character.bytes == 0)
      shown += escaped(static_cast<unsigned char>(text[at]));
    else if (moves_print(character.code))
      shown += escaped(character.code);
    else
      shown += text.substr(at, character.bytes);
    at += character.bytes == 0 ? 1 : character.bytes;
  }
  return shown;
}

bool keeps_its_line(std::string_view text) { return !first_character(text, moves_print); }

std::string first_control_character(std::string_view text) {
  const auto code = first_character(
      text, [](std::uint32_t one) { return is_control(one) && one != '\t' && one != '\n' && one != '\r'; });
  if (!code) return "";
  char name[16];
  std::snprintf(name, sizeof name, "U+%04X", *code);
  return name;
}

std::string printable_start(std::string_view text, std::size_t max_bytes) {
  std::string shown = printable(text.substr(0, 4 * max_bytes));
  if (shown.size() <= max_bytes && text.size() <= 4 * max_bytes) return shown;
  std::size_t end = max_bytes - 3;
  while (end > 0 && (static_cast<unsigned char>(shown[end]) & 0xC0) == 0x80) --end;
  return shown.substr(0, end) + "...";
}

std::string four_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace joulepath
