#include "model/printable.hpp"

#include <gtest/gtest.h>

namespace joulepath {
namespace {

/// The first and last character of each length, and those next to the surrogates [RFC 3629].
TEST(Printable, WellFormedTextStays) {
  for (const std::string text : {"a", "\x7e", "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                                 "\xee\x80\x80", "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_EQ(first_byte_not_utf8(text), std::nullopt) << text;
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, OtherBytesAreNamedAndEscaped) {
  for (const std::string bad : {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xed\xbf\xbf",
                                "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82"}) {
    EXPECT_EQ(first_byte_not_utf8("ab" + bad), 2u) << printable(bad);
    EXPECT_EQ(printable(bad).size(), 4 * bad.size());
  }
  EXPECT_EQ(printable("\xff"), "\\xff");
}

TEST(Printable, ControlCharactersAreEscapedAndNamed) {
  EXPECT_EQ(printable("a\x1b[0m"), "a\\x1b[0m");
  EXPECT_EQ(printable("\x7f\xc2\x80\xc2\x9f "), "\\x7f\\x80\\x9f ");
  EXPECT_EQ(first_control_character("\t\n\r \xff"), "");
  EXPECT_EQ(first_control_character("\t\x1b"), "U+001B");
  EXPECT_EQ(first_control_character("\xc2\x85"), "U+0085");
}

/// Separators of lines and marks that turn the direction of writing move what is printed after them.
TEST(Printable, MarksOfLayoutAreEscaped) {
  for (const auto& [text, shown] :
       {std::pair{"a\nb", "a\\x0ab"}, std::pair{"a\r\tb", "a\\x0d\\x09b"}, std::pair{"\u2028", "\\u2028"},
        std::pair{"\u2029", "\\u2029"}, std::pair{"\u202e", "\\u202e"},
        std::pair{"\u2066x\u2069", "\\u2066x\\u2069"}, std::pair{"\u200f", "\\u200f"},
        std::pair{"\u061c", "\\u061c"}})
    EXPECT_EQ(printable(text), shown);
  for (const std::string text : {"\u2027", "\u202f", "\u2065", "\u206a", "\u05d0", "\u200d"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ACutIsBetweenCharacters) {
  EXPECT_EQ(printable_start("abcdefgh", 8), "abcdefgh");
  EXPECT_EQ(printable_start("abcdefghi", 8), "abcde...");
  EXPECT_EQ(printable_start("abcd\xc3\xa9gh", 8), "abcd\xc3\xa9gh");
  EXPECT_EQ(printable_start("abcd\xc3\xa9ghi", 8), "abcd...");
  EXPECT_EQ(printable_start(std::string(1000, 'x'), 8), "xxxxx...");
}

TEST(FourDigits, AreSignificant) {
  EXPECT_EQ(four_digits(0.000123456), "0.0001235");
  EXPECT_EQ(four_digits(-2.0), "-2");
}

}  // namespace
}  // namespace joulepath
