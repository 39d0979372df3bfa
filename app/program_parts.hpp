#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/diagnose/diagnosis_part.hpp"
#include "app/export_task.hpp"
#include "app/jobs/job_part.hpp"
#include "app/plan/plan_comparison.hpp"

namespace joulepath {

/// What the extensions add to the program; files and formats are in the Registry of scenarios/registry.hpp.
/// Design: docs/decisions/0800-build.md
struct ProgramParts {
  template <class Part>
  using Maker = std::unique_ptr<Part> (*)();
  template <class Part>
  using Makers = std::vector<Maker<Part>>;
  struct ExtensionCommand {
    std::string extension{};
    Maker<Command> make{};
  };

  std::string extension{};  ///< that registers now
  std::vector<ExtensionCommand> commands{};
  Makers<ExportTask> export_tasks{};
  Makers<PlanComparison> comparisons{};
  Makers<DiagnosisPart> diagnosis_parts{};
  Makers<JobPart> job_parts{};

  void add(Maker<Command> make) { commands.push_back({extension, make}); }
};

/// Made by CMake from JOULEPATH_EXTENSIONS (cmake/joulepath_extension.cmake): calls add_NAME_commands() of
/// each.
void add_extension_commands(ProgramParts& parts);

[[nodiscard]] const ProgramParts& extension_parts();

/// One part of each maker: a command has its own, as parts hold the values of options.
template <class Part>
[[nodiscard]] std::vector<std::unique_ptr<Part>> made(
    const std::vector<std::unique_ptr<Part> (*)()>& makers) {
  std::vector<std::unique_ptr<Part>> parts;
  for (const auto make : makers) parts.push_back(make());
  return parts;
}

}  // namespace joulepath
