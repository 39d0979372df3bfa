#include "extensions/studies/commands/quarantine.hpp"

#include <sstream>

#include "model/config_error.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath {

std::map<std::size_t, std::string> read_quarantine(const std::string& file) {
  std::map<std::size_t, std::string> reasons;
  if (file.empty()) return reasons;
  std::istringstream lines(read_text_file(file));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto json = shallow_json(line);
    if (!json.is_object() || !json.contains("index") || !json["index"].is_number_unsigned() ||
        !json.contains("reason") || !json["reason"].is_string())
      throw ConfigError({{file, number, 1}, "", "another line", R"({"index": 3, "reason": "..."})", ""});
    reasons[json["index"].get<std::size_t>()] = json["reason"].get<std::string>();
  }
  return reasons;
}

}  // namespace joulepath
