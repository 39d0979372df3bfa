#include "scenarios/log_files/repaired_dataset.hpp"

#include <algorithm>

#include "scenarios/log_files/dataset_text.hpp"
#include "scenarios/log_files/log_file.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

/// The mappings of each entry of the file while repairs are applied.
class Repairs {
 public:
  Repairs(const Dataset& dataset, const Document& document) {
    const auto columns = document.root().find("columns");
    if (columns) common_ = read_column_sources(*columns);
    const std::vector<Node> entries = document.root()["runs"].items();
    for (const Node& entry : entries) {
      own_.push_back(entry.has("columns") ? read_column_sources(entry["columns"]) : ColumnSources{});
      logs_ += entry.has("motion") ? 0 : 1;
    }
    for (const Run& run : dataset.runs)
      for (std::size_t e = 0; e < entries.size(); ++e)
        if (entries.size() == 1 ||
            (entries[e].mark().line == run.mark.line && entries[e].mark().column == run.mark.column))
          entry_of_run_.push_back(e);
  }

  /// Applies the repair of one check and returns a description of the change.
  std::string apply(const DataCheck& check) {
    std::set<std::size_t> entries;
    for (std::size_t r : check.runs) entries.insert(entry_of_run_[r]);
    if (check.columns.empty()) {
      left_out_.insert(entries.begin(), entries.end());
      return "leave the run out";
    }
    const bool any_own = std::ranges::any_of(own_, [](const ColumnSources& own) { return !own.empty(); });
    if (entries.size() == logs_ && !any_own) {
      const ColumnSources changed = mended(common_, check.columns);
      for (const auto& [name, source] : changed) common_[name] = source;
      return "columns: " + columns_text(changed);
    }
    ColumnSources changed;
    for (std::size_t e : entries) {
      ColumnSources effective = common_;
      for (const auto& [name, source] : own_[e]) effective[name] = source;
      changed = mended(effective, check.columns);
      for (const auto& [name, source] : changed) own_[e][name] = source;
    }
    return "in the run's entry: columns: " + columns_text(changed);
  }

  bool leaves_no_run() const { return left_out_.size() == own_.size(); }

  DatasetEdit edit() const {
    DatasetEdit edit{.columns = common_, .left_out = left_out_};
    for (std::size_t e = 0; e < own_.size(); ++e)
      if (!own_[e].empty()) edit.run_columns[e] = own_[e];
    return edit;
  }

 private:
  static ColumnSources mended(const ColumnSources& sources, const std::vector<ColumnRepair>& columns) {
    ColumnSources changed;
    for (const ColumnRepair& repair : columns) {
      const std::string& from = repair.from.empty() ? repair.column : repair.from;
      const auto found = sources.find(from);
      ColumnSource source = found == sources.end() ? ColumnSource{} : found->second;
      if (!repair.from.empty()) source.from = names_in_file(from, sources);
      source.scale *= repair.scale;
      source.offset *= repair.scale;
      source.is_absent = repair.absent;
      changed[repair.column] = source;
    }
    return changed;
  }

  ColumnSources common_{};
  std::vector<ColumnSources> own_{};
  std::vector<std::size_t> entry_of_run_{};
  std::size_t logs_{};
  std::set<std::size_t> left_out_{};
};

}  // namespace

void describe_repairs(const Dataset& dataset, std::vector<DataCheck>& checks) {
  if (!checks.empty()) describe_repairs(dataset, document_of(dataset), checks);
}

void describe_repairs(const Dataset& dataset, const Document& document, std::vector<DataCheck>& checks) {
  Repairs repairs(dataset, document);
  for (DataCheck& check : checks) check.repair = repairs.apply(check);
}

std::string data_check_text(const DataCheck& check) {
  return (check.run.empty() ? "all runs" : check.run) + ": " + check.channel + " " + check.kind + ". " +
         check.evidence + (check.evidence.ends_with('?') ? " Repair: " : ". Repair: ") + check.repair;
}

std::string repaired_dataset_text(const Dataset& dataset, const std::vector<DataCheck>& checks,
                                  const std::string& directory) {
  Repairs repairs(dataset, document_of(dataset));
  for (const DataCheck& check : checks) static_cast<void>(repairs.apply(check));
  if (repairs.leaves_no_run())
    throw ConfigError({{dataset.file, 1, 1},
                       "runs",
                       "no run that a repair makes usable",
                       "a dataset with a run that can be repaired",
                       "joulepath check lists the findings"});
  DatasetEdit edit = repairs.edit();
  edit.comment = "# Channels repaired by `joulepath check --repair`:\n";
  for (const DataCheck& check : checks)
    edit.comment +=
        "#   " + check.kind + " " + check.channel + (check.run.empty() ? "" : " in " + check.run) + "\n";
  return dataset_text(dataset, edit, directory);
}

}  // namespace joulepath
