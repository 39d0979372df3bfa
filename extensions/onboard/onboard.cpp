#include "scenarios/registry.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

namespace embedded {
extern const std::string_view onboard_schemas;
}

void add_onboard(Registry& registry) {
  registry.kinds.push_back({"drift", [] { return schema_in(embedded::onboard_schemas, "drift", true); },
                            "result of drift --json"});
}

}  // namespace joulepath
