#include "studio/server/page.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "app/report/page_text.hpp"
#include "scenarios/document.hpp"
#include "studio/modules.hpp"

namespace joulepath::embedded {
extern const std::string_view studio_page, studio_style, studio_core_js, studio_core_wasm;
}  // namespace joulepath::embedded

namespace joulepath::studio {
namespace {

/// A text for a script element that browsers do not run; no part of it can end the element.
std::string shielded(std::string_view text) {
  std::string out(text);
  for (std::size_t at = 0; (at = out.find("</script", at)) != std::string::npos; at += 9)
    out.replace(at, 8, "<\\/script");
  return out;
}

std::string modules(const std::string& from) {
  std::string text;
  for (const auto& [name, embedded] : kModules)
    text += "<script type=\"text/x-module\" data-name=\"studio/" + std::string(name) + ".js\">\n" +
            shielded(from.empty() ? std::string(embedded)
                                  : read_text_file(from + "/js/" + std::string(name) + ".js")) +
            "</script>\n";
  return text;
}

}  // namespace

bool has_web_assembly() { return !embedded::studio_core_wasm.empty(); }

std::string page(const nlohmann::json& data, const std::string& from) {
  const auto file = [&](std::string_view embedded, const char* name) {
    return from.empty() ? std::string(embedded) : read_text_file(from + "/" + name);
  };
  nlohmann::json versioned = data;
  versioned["version"] = JOULEPATH_VERSION;
  return report::filled(file(embedded::studio_page, "studio.html"),
                        {{"@STYLE@", file(embedded::studio_style, "studio.css")},
                         {"@MODULES@", modules(from)},
                         {"@CORE_JS@", shielded(embedded::studio_core_js)},
                         {"@CORE_WASM@", std::string(embedded::studio_core_wasm)},
                         {"@DATA@", report::script_safe(versioned)}});
}

}  // namespace joulepath::studio
