#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/command.hpp"
#include "app/export_task.hpp"
#include "app/jobs/job_part.hpp"
#include "app/plan/plan_comparison.hpp"

namespace joulepath {

/// What the extensions add to the program; files and formats are in the Registry of scenarios/registry.hpp.
/// Design: docs/decisions/0800-build.md
struct ProgramParts {
  std::string extension{};  ///< that adds now
  std::vector<std::unique_ptr<Command>> commands{};
  std::vector<std::unique_ptr<ExportTask>> export_tasks{};
  std::vector<std::unique_ptr<PlanComparison>> comparisons{};
  std::vector<std::unique_ptr<JobPart>> job_parts{};

  void add(std::unique_ptr<Command> command) {
    command->belongs_to(extension);
    commands.push_back(std::move(command));
  }
};

/// Made by CMake from JOULEPATH_EXTENSIONS (cmake/joulepath_extension.cmake): calls add_NAME_commands() of
/// each.
void add_extension_commands(ProgramParts& parts);

[[nodiscard]] inline ProgramParts extension_parts() {
  ProgramParts parts;
  add_extension_commands(parts);
  return parts;
}

}  // namespace joulepath
