#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace joulepath {

/// Nanoseconds since 1970 of a time as ISO 8601 writes it, `2026-05-01T12:30:15.25Z`: a blank instead of T,
/// an offset (`+02:00`) instead of Z, or none (UTC) are accepted.
[[nodiscard]] std::optional<std::uint64_t> utc_nanoseconds(std::string_view text);

}  // namespace joulepath
