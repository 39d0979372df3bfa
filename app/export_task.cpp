#include "app/export_task.hpp"

#include <filesystem>
#include <iostream>

#include "app/output_directory.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {

void need_robot_for(const std::string& input, const ExportArguments& arguments) {
  if (arguments.source.robot_file.empty())
    throw ConfigError({{arguments.source.file, 0, 0},
                       "",
                       input + ", which names no robot",
                       "--robot with the name of a robot file",
                       ""});
}

void write_export_files(const std::vector<ExportFile>& files, const CommonOptions& common) {
  for (const ExportFile& file : files)
    if (!common.force && std::filesystem::exists(file.name))
      throw ConfigError(
          {{file.name, 0, 0}, "", "a file that exists", "a new name", "--force overwrites it"});
  for (const ExportFile& file : files) write_output_file(file.name, file.content, common.force);
}

void tell_export_files(const std::vector<ExportFile>& files) {
  std::cout << "written: " << text_of_list(files, &ExportFile::name) << "\n";
}

}  // namespace joulepath
