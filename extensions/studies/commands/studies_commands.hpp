#pragma once

#include <memory>

#include "app/command.hpp"
#include "app/jobs/job_part.hpp"

namespace joulepath {

[[nodiscard]] std::unique_ptr<Command> make_sweep_command();
[[nodiscard]] std::unique_ptr<Command> make_merge_command();
[[nodiscard]] std::unique_ptr<JobPart> make_shard_part();

}  // namespace joulepath
