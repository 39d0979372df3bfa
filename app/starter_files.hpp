#pragma once

#include <string_view>

/// The files of app/starter/, embedded by the build.
namespace joulepath::embedded {
extern const std::string_view starter_robot;
extern const std::string_view starter_map;
extern const std::string_view starter_mission;
extern const std::string_view starter_dataset;
}  // namespace joulepath::embedded
