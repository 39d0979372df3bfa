#pragma once

#include <string>

namespace joulepath {

/// docs/effects.md: the catalog as a document, one section per effect, with the counterparts in Gazebo and
/// MuJoCo. The committed file must be this text (a test checks it).
[[nodiscard]] std::string effects_markdown();

}  // namespace joulepath
