#include "extensions/studio/server/page.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "app/report/page_text.hpp"
#include "extensions/studio/modules.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/filled.hpp"

namespace joulepath::embedded {
extern const std::string_view studio_page, studio_style, studio_core_js, studio_core_wasm;
}  // namespace joulepath::embedded

namespace joulepath::studio {

bool has_web_assembly() { return !embedded::studio_core_wasm.empty(); }

std::string page(const nlohmann::json& data, const std::string& tree) {
  const auto file = [&](std::string_view embedded, const char* name) {
    return tree.empty() ? std::string(embedded) : read_text_file(tree + "/extensions/studio/page/" + name);
  };
  nlohmann::json versioned = data;
  versioned["version"] = JOULEPATH_VERSION;
  return filled(file(embedded::studio_page, "studio.html"),
                {{"@PAGE_STYLE@", report::shared_style()},
                 {"@STYLE@", file(embedded::studio_style, "studio.css")},
                 {"@MODULES@", report::module_scripts(report::shared_modules(), tree) +
                                   report::module_scripts(report::kStudioModules, tree)},
                 {"@BOOT@", report::boot_script()},
                 {"@CORE_JS@", report::shielded(embedded::studio_core_js)},
                 {"@CORE_WASM@", std::string(embedded::studio_core_wasm)},
                 {"@DATA@", report::script_safe(versioned)}});
}

}  // namespace joulepath::studio
