#include "app/export_task.hpp"

#include <filesystem>
#include <iostream>

#include "app/output_directory.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {

void write_export_files(const std::vector<ExportFile>& files, const CommonOptions& common) {
  for (const ExportFile& file : files)
    if (!common.force && std::filesystem::exists(file.name))
      throw ConfigError({{file.name, 0, 0}, "", "a file that exists", "a new name", "--force overwrites it"});
  for (const ExportFile& file : files) write_output_file(file.name, file.content, common.force);
}

void tell_export_files(const std::vector<ExportFile>& files) {
  std::cout << "written: " << text_of_list(files, &ExportFile::name) << "\n";
}

}  // namespace joulepath
