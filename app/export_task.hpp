#pragma once

#include <string>
#include <vector>

#include "app/command.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/mission_files/mission_source.hpp"

namespace joulepath {

/// The arguments of `export`, as far as they do not belong to a plan.
struct ExportArguments {
  MissionSource source{};
  std::string out{};
  CommonOptions common{};
};

/// A format of `export` for input that is not a mission: it makes no plan, and may have options of its own.
class ExportTask {
 public:
  ExportTask(std::string name, std::string says, std::string example)
      : name_(std::move(name)), says_(std::move(says)), example_(std::move(example)) {}
  ExportTask(const ExportTask&) = delete;
  ExportTask& operator=(const ExportTask&) = delete;
  virtual ~ExportTask() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& says() const { return says_; }
  [[nodiscard]] const std::string& example() const { return example_; }
  virtual void declare(CommandLine& line) = 0;
  [[nodiscard]] virtual int run(const ExportArguments& arguments) = 0;

 private:
  std::string name_;
  std::string says_;
  std::string example_;
};

/// All or none: an existing file is reported before anything is written.
void write_export_files(const std::vector<ExportFile>& files, const CommonOptions& common);
void tell_export_files(const std::vector<ExportFile>& files);

}  // namespace joulepath
