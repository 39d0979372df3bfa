#include "extensions/studies/study_file.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

FileSummary check_study(const std::string& file, const ReadOptions& options) {
  const Study study = study_from(Document::load(file), options);
  const std::vector<MissionItem> missions = study_missions(study);
  check_designs(study, document_of(missions.front()), options);
  for (const MissionItem& mission : missions)
    static_cast<void>(mission_of_design(study, document_of(mission), study.designs.at(0), options));
  return {"study",
          counted(study.designs.size(), "design") + " of " + counted(study.targets.size(), "parameter") +
              " on " + counted(missions.size(), "mission"),
          {}};
}

}  // namespace

void add_studies(Registry& registry) {
  registry.files.push_back({.kind = "study", .key = "parameters", .check = check_study});
  registry.kinds.push_back(
      {"study", study_schema, "designs of a robot or a mission to compare: joulepath sweep"});
  registry.kinds.push_back({"sweep", sweep_schema, "result of sweep: sweep.json"});
  registry.kinds.push_back(
      {"shard", shard_schema, "shard.json: data of one part of a batch or a sweep for merge"});
}

}  // namespace joulepath
