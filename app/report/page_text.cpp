#include "app/report/page_text.hpp"

#include <nlohmann/json.hpp>

namespace joulepath::report {

std::string script_safe(const nlohmann::json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string out;
  while (!page.empty()) {
    const std::size_t at = page.find('@');
    out += page.substr(0, at);
    if (at == std::string_view::npos) break;
    page.remove_prefix(at);
    bool known = false;
    for (const auto& [name, value] : values) {
      if (!page.starts_with(name)) continue;
      out += value;
      page.remove_prefix(name.size());
      known = true;
      break;
    }
    if (known) continue;
    out += '@';
    page.remove_prefix(1);
  }
  return out;
}

}  // namespace joulepath::report
