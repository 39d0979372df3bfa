#include "scenarios/text/schema_text.hpp"

#include <gtest/gtest.h>

#include "diagnosis/values/verdict.hpp"
#include "model/config_error.hpp"
#include "scenarios/result_files/output_schemas.hpp"

namespace joulepath {
namespace {

Schema of_phrase(const std::string& phrase) {
  return schema_in("it: '" + phrase + "'\nword: text\n", "it", false, {{"given", boolean()}});
}

TEST(SchemaText, APhraseSaysWhatIsAccepted) {
  for (const auto& [phrase, accepted] : std::vector<std::pair<std::string, std::string>>{
           {"number", "a number"},
           {"number from 0", "a number >= 0"},
           {"number above 0 to 5", "a number > 0 and <= 5"},
           {"integer from 2 to 1e5", "a whole number from 2 to 100000"},
           {"boolean", "true or false"},
           {"word", "a text"},
           {"given", "true or false"},
           {"one of red, green", "one of: red, green"},
           {"any of number, word", "a number, or a text"},
           {"list of number above 0", "a list, each a number > 0"},
           {"2 of 3 of number", "a list of 2, each a list of 3, each a number"},
           {"1 or more word", "a list of at least 1, each a text"},
           {"map of number from 0", "a map whose values are each a number >= 0"},
           {"sided number", "a number, or a map with keys left, right"}})
    EXPECT_EQ(accepted_by(of_phrase(phrase)), accepted) << phrase;
  EXPECT_TRUE(of_phrase("word or null").nullable);
  EXPECT_EQ(of_phrase("3 to 10 of word").max_items, 10u);
  EXPECT_THROW(static_cast<void>(of_phrase("nothing of the kind")), ConfigError);
}

TEST(SchemaText, AMapSaysWhichKeysAreNeeded) {
  const Schema schema = schema_in(
      "it:\n  (exactly one): a, b\n  a?: [number, the first]\n  b?: text\n  c: boolean\n", "it", true);
  EXPECT_TRUE(schema.open);
  ASSERT_EQ(schema.keys.size(), 3u);
  EXPECT_EQ(schema.keys[0].name, "a");
  EXPECT_EQ(schema.keys[0].says, "the first");
  EXPECT_FALSE(schema.keys[0].required);
  EXPECT_TRUE(schema.keys[2].required);
  EXPECT_EQ(schema.exactly_one, (std::vector<std::vector<std::string>>{{"a", "b"}}));
}

TEST(SchemaText, ResultsKnowTheVerdictsOfTheDiagnosis) {
  std::vector<std::string> names;
  for (const VerdictWords& words : kVerdicts) names.emplace_back(words.name);
  EXPECT_EQ(result_schema("verdict").choices, names);
}

}  // namespace
}  // namespace joulepath
