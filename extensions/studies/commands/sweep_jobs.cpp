#include "extensions/studies/commands/sweep_jobs.hpp"

#include <nlohmann/json.hpp>

#include "app/jobs/content_hash.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// One design of a study as a variation of its missions.
class DesignVariant : public MissionVariant {
 public:
  DesignVariant(const Study& study, const std::vector<std::string>& design, ReadOptions reading)
      : study_(study), design_(design), reading_(reading) {}

  MissionRequest mission(const Document& document) const override {
    MissionRequest request = mission_of_design(study_, document, design_, reading_);
    if (!study_.robot_file.empty()) request.robot_file = study_.robot_file;
    return request;
  }
  Robot robot(const std::string& robot_file) const override {
    return robot_of_design(study_, Document::load(robot_file, study_.robot_named_by), design_);
  }

 private:
  const Study& study_;
  const std::vector<std::string>& design_;
  ReadOptions reading_;
};

/// Numbers become JSON numbers, other texts JSON strings.
Json json_value(const std::string& text) {
  const auto number = parse_number(text);
  return number ? Json(*number) : Json(text);
}

}  // namespace

SweepJobs::SweepJobs(const Study& study, const PlanOptions& options, const ReadOptions& reading,
                     const CacheChoice& cache)
    : study_(study), missions_(study_missions(study)), reading_(reading), planner_(options, reading, cache) {
  check_designs(study, document_of(missions_.front()), reading);
}

Json SweepJobs::line_of(const MissionItem& mission, const std::vector<std::string>& design,
                        std::size_t number, std::size_t index) const {
  Json line{{"index", index}, {"design", number}, {"mission", mission.name}};
  for (std::size_t p = 0; p < design.size(); ++p)
    line["parameters"][study_.designs.parameters()[p].name] = json_value(design[p]);
  return line;
}

std::string SweepJobs::name_line(std::size_t index) const {
  const std::size_t number = index / missions_.size();
  return line_of(missions_[index % missions_.size()], study_.designs.at(number), number, index).dump();
}

JobResult SweepJobs::plan_on(const MissionItem& mission, const std::vector<std::string>& design,
                             std::size_t number, std::size_t index) {
  const DesignVariant variant(study_, design, reading_);
  return planner_.plan(mission, index, line_of(mission, design, number, index), &variant);
}

JobResult SweepJobs::plan(std::size_t index) {
  const std::size_t number = index / missions_.size();
  return plan_on(missions_[index % missions_.size()], study_.designs.at(number), number, index);
}

std::vector<JobResult> SweepJobs::plan_design(const std::vector<std::string>& design, std::size_t number) {
  std::vector<JobResult> results;
  for (std::size_t m = 0; m < missions_.size(); ++m)
    results.push_back(plan_on(missions_[m], design, number, number * missions_.size() + m));
  return results;
}

/// Of the study, only what a plan depends on: constraints and objectives may change.
std::string SweepJobs::fingerprint(std::size_t index) {
  const std::size_t number = index / missions_.size();
  const MissionItem& mission = missions_[index % missions_.size()];
  const std::vector<std::string> design = study_.designs.at(number);
  const DesignVariant variant(study_, design, reading_);  // its values may name files
  const std::string of_mission = planner_.fingerprint(mission, &variant);
  if (of_mission.empty()) return "";
  ContentHash hash;
  hash.mix(of_mission).mix(line_of(mission, design, number, index).dump());
  for (const StudyTarget& target : study_.targets)
    hash.mix((target.in_robot ? "robot." : "mission.") + target.path);
  return hash.mix(study_.friction == FrictionHeld::wheel ? "wheel" : "motor").text();
}

std::string SweepJobs::digest() const {
  return ContentHash().mix(digest_of(missions_)).mix(study_.text).text();
}

}  // namespace joulepath
