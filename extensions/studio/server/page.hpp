#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
// Design: docs/decisions/0702-studio-and-reports.md

namespace joulepath::studio {

/// The studio's page in one text that needs nothing else: markup, style, modules, the WebAssembly where the
/// build has it, and data. `tree`: the source tree to take the page's files from; empty: those that the
/// program holds.
[[nodiscard]] std::string page(const nlohmann::json& data, const std::string& tree = {});

/// True if the page can plan without the program.
[[nodiscard]] bool has_web_assembly();

}  // namespace joulepath::studio
