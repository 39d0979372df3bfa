#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "model/printable.hpp"
#include "scenarios/any_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

/// The error message for a text; empty: the text is accepted.
std::string refusal(const std::string& file, const std::string& text) {
  try {
    static_cast<void>(Document::parse(text, file));
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(JsonDocument, ValuesKeepTheirPlaceTheirDigitsAndTheirPointer) {
  const Document document = Document::parse(
      "{\"a\": [1.50, -2e3, true, null, \"x\"],\n \"b/c\": {\"d~e\": \"\\u00e4\\n\", \"f\": {}}}", "a.json");
  const Node root = document.root(), list = root["a"], text = root["b/c"]["d~e"];
  EXPECT_EQ(list.items()[0].value().text, "1.50");
  EXPECT_EQ(list.items()[1].number(), -2000.0);
  EXPECT_TRUE(list.items()[2].boolean());
  EXPECT_EQ(list.items()[3].kind(), Value::Kind::null);
  EXPECT_EQ(list.items()[4].path(), "/a/4");
  EXPECT_EQ(list.items()[1].mark().column, 14);
  EXPECT_EQ(text.text(), "\u00e4\\x0a");
  EXPECT_EQ(text.path(), "/b~1c/d~0e");
  EXPECT_EQ(text.mark().line, 2);
  EXPECT_EQ(text.mark().column, 17);
  EXPECT_TRUE(text.value().quoted);
}

TEST(JsonDocument, AMistakeIsToldWithItsLineAndColumn) {
  EXPECT_TRUE(holds(refusal("a.json", "{\"a\": 1,\n}"), "a.json:2:1: found text that is not JSON"));
  EXPECT_TRUE(holds(refusal("a.json", "{\"a\": 1},"), "a.json:1:9: found text that is not JSON"));
  EXPECT_TRUE(holds(refusal("a.json", "{\"a\": 1, \"a\": 2}"), "a.json:1:10: /a: found a duplicate key"));
  EXPECT_TRUE(holds(refusal("a.geojson", ""), "a.geojson:1:1: found text that is not JSON"));
  EXPECT_TRUE(holds(refusal("a.json", "{\"a\": 1e999}"), "not JSON"));
  EXPECT_TRUE(holds(refusal("a.json", "[\"\\ud800\"]"), "not JSON"));
}

TEST(Document, ACommaDoesNotBecomeDocumentsWithoutEnd) {
  for (const char* text : {",", ",,,", "a: 1\n,", "{a: 1},", "[1, 2],\n", "]", "}"})
    EXPECT_FALSE(refusal("a.yaml", text).empty()) << text;
  EXPECT_TRUE(holds(refusal("a.yaml", "a: 1\n---\nb: 2\n"), "a.yaml:2:1: found a second YAML document"));
  EXPECT_EQ(refusal("a.yaml", "---\na: 1\n...\n"), "");
  EXPECT_EQ(refusal("a.yaml", "a: 1\n---\n"), "") << "a message of ROS";
  EXPECT_EQ(refusal("a.yaml", ""), "");
}

TEST(Document, NestingValuesAndAliasesAreBounded) {
  EXPECT_TRUE(holds(refusal("a.json", std::string(100'000, '[')), "64 deep"));
  EXPECT_TRUE(holds(refusal("a.yaml", std::string(100, '[') + std::string(100, ']')), "64 deep"));
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < 10; ++k) {
    const std::string name = "a" + std::to_string(k), before = "*a" + std::to_string(k - 1);
    bomb += name + ": &" + name + " [" + before;
    for (int i = 0; i < 9; ++i) bomb += ", " + before;
    bomb += "]\n";
  }
  EXPECT_TRUE(holds(refusal("a.yaml", bomb), "more than 2,000,000 values"));
  EXPECT_TRUE(holds(refusal("a.yaml", "a: &x [*x]"), "alias"));
  EXPECT_TRUE(holds(refusal("a.yaml", "a: " + std::string(std::size_t{9} << 20, 'x')), "bytes"));
}

TEST(Document, AnAliasIsACopyOfItsAnchor) {
  const Document document = Document::parse("a: &x {b: 1}\nc: *x\nd: &y 2\ne: [*y, *x]\n", "a.yaml");
  EXPECT_EQ(document.root()["c"]["b"].number(), 1);
  EXPECT_EQ(document.root()["e"].items()[0].number(), 2);
  EXPECT_EQ(document.root()["e"].items()[1]["b"].number(), 1);
}

TEST(Document, AHundredThousandKeysAreReadAndTheLastIsCompared) {
  std::string text;
  for (int k = 0; k < 100'000; ++k) text += "key_" + std::to_string(k) + ": 1\n";
  EXPECT_EQ(refusal("a.yaml", text), "");
  EXPECT_TRUE(holds(refusal("a.yaml", text + "key_0: 2\n"), "the first one is on line 1"));
}

TEST(Document, TextIsUtf8WithoutControlCharacters) {
  EXPECT_TRUE(holds(refusal("a.yaml", "a: 1\nname: \xff\n"), "a.yaml:2:7: found the byte \\xff"));
  EXPECT_TRUE(holds(refusal("a.json", "{\"name\": \"\xc3\"}"), "a.json:1:11: found the byte \\xc3"));
  EXPECT_TRUE(holds(refusal("a.yaml", "name: \"\\x1b[2J\""), "the control character U+001B"));
  EXPECT_TRUE(
      holds(refusal("a.json", "{\"a\": [1, \"\\u009b\"]}"), "/a/1: found the control character U+009B"));
  EXPECT_EQ(refusal("a.yaml", "name: \"\\u00e4\\t\\n\""), "");
}

/// No text of a document forges a line where it is printed: values, keys, aliases, headers of tables.
TEST(Document, TextsAreOfOneLine) {
  const auto lines = [](const std::string& text) {
    return std::ranges::count_if(text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
  };
  for (const std::string mark : {"\\n", "\\r", "\\t", "\\u2028", "\\u202e"}) {
    const Document yaml =
        Document::parse("name: &n \"x" + mark + "y\"\nagain: *n\n\"k" + mark + "\": 1\n", "a.yaml");
    const Document json = Document::parse("{\"name\": \"x" + mark + "y\", \"k" + mark + "\": 1}", "a.json");
    for (const Document* document : {&yaml, &json})
      for (const auto& [key, value] : document->root().entries())
        for (const std::string& text : {key, value.text(), value.path()}) {
          EXPECT_EQ(printable(text), text);
          EXPECT_EQ(lines(text), 0) << key;
        }
  }
  const Document block = Document::parse("name: |\n  x\n  robot.yaml: ok\n", "a.yaml");
  EXPECT_EQ(lines(block.root()["name"].text()), 0);
}

TEST(Printable, ControlCharactersAndBrokenBytesAreEscaped) {
  EXPECT_EQ(printable("a\x1b[31m.yaml"), "a\\x1b[31m.yaml");
  EXPECT_EQ(printable("\xff and \xc2\x9b and \xc3\xa4"), "\\xff and \\x9b and \u00e4");
  EXPECT_EQ(printable_start(std::string(100, 'x'), 10), "xxxxxxx...");
  EXPECT_EQ(printable_start("123456\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4", 10), "123456...");
}

TEST(InputFile, APipeADeviceAndADirectoryAreRefused) {
  const ScratchDirectory scratch;
  ASSERT_EQ(::mkfifo(scratch.at("pipe.yaml").c_str(), 0600), 0);
  for (const std::string& file : {scratch.at("pipe.yaml"), std::string("/dev/zero"), scratch.at("")})
    EXPECT_THROW(static_cast<void>(read_any_file(file, "robot")), ConfigError) << file;
}

}  // namespace
}  // namespace joulepath
