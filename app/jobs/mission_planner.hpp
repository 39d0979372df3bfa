#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/jobs/cache_choice.hpp"
#include "app/jobs/run_jobs.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/mission_files/mission_list.hpp"

namespace joulepath {

/// Digest of missions without the files that they name.
[[nodiscard]] std::string digest_of(const std::vector<MissionItem>& items);

/// A variation of a mission: what a sweep changes.
class MissionVariant {
 public:
  MissionVariant() = default;
  MissionVariant(const MissionVariant&) = delete;
  MissionVariant& operator=(const MissionVariant&) = delete;
  virtual ~MissionVariant() = default;

  [[nodiscard]] virtual MissionRequest mission(const Document& document) const = 0;
  /// `robot_file`: the robot that the mission names.
  [[nodiscard]] virtual Robot robot(const std::string& robot_file) const = 0;
};

/// Plans many missions. Maps, keep-out masks and the floors prepared from them are built once and shared;
/// answers about equal legs are shared as well. Safe to call from several threads.
class MissionPlanner {
 public:
  /// `confidence`: instead of the missions' own.
  MissionPlanner(const PlanOptions& options, const ReadOptions& reading,
                 const CacheChoice& cache = {.none = true}, std::optional<double> confidence = {})
      : options_(options), reading_(reading), confidence_(confidence), answers_(answer_cache(cache)) {}

  /// The result line: `line` with the plan's figures, or the reason why there is none.
  [[nodiscard]] JobResult plan(const MissionItem& item, std::size_t index, nlohmann::ordered_json line,
                               const MissionVariant* variant = nullptr);

  /// Identifies a mission and everything on which its result depends; empty when a file cannot be read.
  [[nodiscard]] std::string fingerprint(const MissionItem& item, const MissionVariant* variant = nullptr);

  /// Of all missions whose fingerprint was computed: files and the digests of their content.
  [[nodiscard]] std::map<std::string, std::string> files_read() const;
  /// The options of the command line that change results, by their names.
  [[nodiscard]] std::map<std::string, std::string> options() const;

 private:
  struct Place {
    MissionWorld world{};
    std::optional<RouteSpace> space{};
    ContentKey floor{};
  };
  [[nodiscard]] MissionRequest mission_of(const MissionItem& item, const MissionVariant* variant) const;
  const Place& place_of(const MissionRequest& mission);
  [[nodiscard]] Plan plan_of(const MissionRequest& mission, const MissionVariant* variant);
  [[nodiscard]] std::string content_digest(const std::string& file);

  PlanOptions options_;
  ReadOptions reading_;
  std::optional<double> confidence_;
  std::unique_ptr<AnswerCache> answers_;
  std::mutex mutex_{};
  std::map<std::string, std::unique_ptr<Place>> places_{};
  mutable std::mutex digests_mutex_{};
  std::map<std::string, std::string> digests_{};
};

/// The missions of a batch.
class MissionJobs : public JobList {
 public:
  MissionJobs(std::vector<MissionItem> items, const PlanOptions& options, const ReadOptions& reading,
              const CacheChoice& cache = {.none = true}, std::optional<double> confidence = {})
      : items_(std::move(items)), planner_(options, reading, cache, confidence) {}

  [[nodiscard]] std::size_t size() const override { return items_.size(); }
  [[nodiscard]] JobResult plan(std::size_t index) override;
  [[nodiscard]] std::string name_line(std::size_t index) const override;
  [[nodiscard]] std::string fingerprint(std::size_t index) override {
    return planner_.fingerprint(items_[index]);
  }
  [[nodiscard]] std::string digest() const override { return digest_of(items_); }
  [[nodiscard]] std::map<std::string, std::string> options() const override { return planner_.options(); }
  [[nodiscard]] std::map<std::string, std::string> files_read() const override {
    return planner_.files_read();
  }

 private:
  std::vector<MissionItem> items_;
  MissionPlanner planner_;
};

}  // namespace joulepath
