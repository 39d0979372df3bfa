#include "app/report/page_text.hpp"

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "report/page_modules.hpp"

namespace joulepath::embedded {
extern const std::string_view page_style, page_boot;
}  // namespace joulepath::embedded

namespace joulepath::report {
namespace {

std::string read_whole(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

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

std::string shielded(std::string_view text) {
  std::string out(text);
  for (std::size_t at = 0; (at = out.find("</script", at)) != std::string::npos; at += 9)
    out.replace(at, 8, "<\\/script");
  return out;
}

std::string module_scripts(std::span<const Module> modules, const std::string& tree) {
  std::string text;
  for (const Module& module : modules)
    text += "<script type=\"text/x-module\" data-name=\"" + std::string(module.name) + "\">\n" +
            shielded(tree.empty() ? std::string(module.text)
                                  : read_whole(tree + "/" + std::string(module.file))) +
            "</script>\n";
  return text;
}

std::span<const Module> shared_modules() { return kPageModules; }

std::string day() {
  const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
  const long long stated = fixed ? std::atoll(fixed) : 0;
  const std::time_t now = stated > 0 ? static_cast<std::time_t>(stated) : std::time(nullptr);
  std::tm parts{};
  char text[16];
  return gmtime_r(&now, &parts) && std::strftime(text, sizeof text, "%Y-%m-%d", &parts) ? text : "";
}

std::string shared_style() { return std::string(embedded::page_style); }
std::string boot_script() { return std::string(embedded::page_boot); }

}  // namespace joulepath::report
