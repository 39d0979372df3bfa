#include "app/program_parts.hpp"

namespace joulepath {

std::unique_ptr<Command> make_sweep_command();
std::unique_ptr<Command> make_merge_command();
std::unique_ptr<JobPart> make_shard_part();

void add_studies_commands(ProgramParts& parts) {
  parts.add(make_sweep_command);
  parts.add(make_merge_command);
  parts.job_parts.push_back(make_shard_part);
}

}  // namespace joulepath
