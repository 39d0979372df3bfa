#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace joulepath::report {

/// JSON as headings and tables of HTML, for browsers that run no scripts: an object's numbers and texts as
/// rows, a list of objects as one table. Long lists of numbers are left out; of long tables the first rows
/// are shown.
[[nodiscard]] std::string plain_tables(const nlohmann::json& value);

}  // namespace joulepath::report
