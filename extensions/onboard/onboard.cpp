#include "extensions/onboard/drift_schema.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {

void add_onboard(Registry& registry) {
  registry.kinds.push_back({"drift", drift_schema, "result of drift --json"});
}

}  // namespace joulepath
