#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
// Design: docs/decisions/0331-a-page-of-plain-modules.md

namespace joulepath::studio {

/// The studio's page as one self-contained text: markup, style, modules, the WebAssembly if the build
/// contains it, and data. `from`: a folder with the page's files; empty: the files inside the program.
[[nodiscard]] std::string page(const nlohmann::json& data, const std::string& from = {});

/// True if the page can plan without the program.
[[nodiscard]] bool has_web_assembly();

}  // namespace joulepath::studio
