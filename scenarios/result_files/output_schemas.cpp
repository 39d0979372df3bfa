#include "scenarios/result_files/output_schemas.hpp"

#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

Schema result_schema(const std::string& name) { return schema_in(embedded::result_schemas, name, true); }

}  // namespace joulepath
