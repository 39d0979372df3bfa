#include "extensions/studies/commands/studies_commands.hpp"

#include "app/program_parts.hpp"

namespace joulepath {

void add_studies_commands(ProgramParts& parts) {
  parts.add(make_sweep_command);
  parts.add(make_merge_command);
  parts.job_parts.push_back(make_shard_part);
}

}  // namespace joulepath
