#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace joulepath::report {

/// JSON for a script element: no "<" in it can close the element or open a comment.
[[nodiscard]] std::string script_safe(const nlohmann::json& data);

/// Text of an HTML element.
[[nodiscard]] std::string escaped(std::string_view text);

/// A JavaScript module of a page: imported by its name; `file` is where it lies in the source tree.
struct Module {
  std::string_view name{}, file{}, text{};
};

/// The modules that every page shares (app/report/page/).
[[nodiscard]] std::span<const Module> shared_modules();

/// Script elements that hold modules until the page's boot script names them. `tree`: the source tree to read
/// them from; empty: as built in.
[[nodiscard]] std::string module_scripts(std::span<const Module> modules, const std::string& tree = {});

/// The day that pages name (YYYY-MM-DD, universal time): today, or that of SOURCE_DATE_EPOCH
/// (reproducible-builds.org).
[[nodiscard]] std::string day();

/// Style and boot script that every page shares.
[[nodiscard]] std::string shared_style();
[[nodiscard]] std::string boot_script();

/// Text inside of a script element that no browser runs: nothing in it can end the element.
[[nodiscard]] std::string shielded(std::string_view text);

}  // namespace joulepath::report
