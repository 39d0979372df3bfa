// docs/equations.md names the code of each equation: these names must exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kSource = JOULEPATH_SOURCE_DIR;

std::string content(const std::string& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Names of all tests in the tree, as Suite.Name.
std::set<std::string> all_tests() {
  std::set<std::string> names;
  const std::regex test(R"(TEST(?:_F)?\(\s*(\w+),\s*(\w+)\))");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource + "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = content(entry.path().string());
    for (std::sregex_iterator match(text.begin(), text.end(), test), end; match != end; ++match)
      names.insert((*match)[1].str() + "." + (*match)[2].str());
  }
  return names;
}

TEST(EquationsDocument, NamesFunctionsAndTestsThatExist) {
  const std::set<std::string> tests = all_tests();
  std::istringstream lines(content(kSource + "/docs/equations.md"));
  const std::regex row(R"(^\| .* \| `(\w+)\(\)` in `([\w/.]+)` \| `(\w+\.\w+)` \|$)");
  std::string line;
  int rows = 0;
  while (std::getline(lines, line)) {
    if (line.rfind("| ", 0) != 0 || line.rfind("| eq.", 0) == 0) continue;
    std::smatch match;
    ASSERT_TRUE(std::regex_match(line, match, row)) << line;
    ++rows;
    const std::string file = content(kSource + "/" + match[2].str());
    EXPECT_NE(file.find(match[1].str() + "("), std::string::npos) << match[1] << " in " << match[2];
    EXPECT_TRUE(tests.contains(match[3].str())) << match[3];
  }
  EXPECT_GT(rows, 20);
}

TEST(EquationsDocument, CoversEveryEquationOfThePaper) {
  std::set<int> covered;
  std::istringstream lines(content(kSource + "/docs/equations.md"));
  const std::regex first_cell(R"(^\| ([0-9][0-9, –]*) ?[^|]*\|.*)");
  const std::regex part(R"((\d+)(?:–(\d+))?)");
  std::string line;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (!std::regex_match(line, match, first_cell)) continue;
    const std::string cell = match[1].str();
    for (std::sregex_iterator m(cell.begin(), cell.end(), part), end; m != end; ++m) {
      const int from = std::stoi((*m)[1].str());
      const int to = (*m)[2].matched ? std::stoi((*m)[2].str()) : from;
      for (int k = from; k <= to; ++k) covered.insert(k);
    }
  }
  for (int k = 1; k <= 37; ++k) EXPECT_TRUE(covered.contains(k)) << "eq. " << k;
}

}  // namespace
}  // namespace joulepath
