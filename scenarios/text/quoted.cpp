#include "scenarios/text/quoted.hpp"

#include <nlohmann/json.hpp>

namespace joulepath {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace joulepath
