#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/motion_entry.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

Schema mission_schema() {
  return with_physical_bounds(schema_in(embedded::mission_schemas, "mission", false,
                                        {{"bezier", bezier_schema()},
                                         {"motion", motion_schema()},
                                         {"confidence", number({kLeastConfidence, kGreatestConfidence})}}));
}

}  // namespace joulepath
