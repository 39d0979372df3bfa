#include "app/commands/batch_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "model/printable.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "scenarios/mission_file.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

std::vector<BatchItem> items_of_directory(const std::filesystem::path& directory) {
  std::vector<BatchItem> items;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && (extension == ".yaml" || extension == ".yml"))
      items.push_back({.name = printable(entry.path().stem().string()), .file = entry.path().string()});
  }
  std::sort(items.begin(), items.end(),
            [](const BatchItem& a, const BatchItem& b) { return a.file < b.file; });
  return items;
}

std::vector<BatchItem> items_of_lines(const std::string& file) {
  std::vector<BatchItem> items;
  std::istringstream lines(read_text_file(file));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      items.push_back(
          {.name = "line_" + std::to_string(number), .file = file, .text = line, .first_line = number});
  return items;
}

/// A batch result of a plan: the figures that a report or a fleet manager sorts by.
Json plan_line(const Plan& plan) {
  Json json{{"status", solve_status_name(plan.status)}};
  if (plan.infeasibility) {
    json["constraint"] = plan.infeasibility->reason.constraint;
    json["leg"] = plan.infeasibility->leg;
    json["message"] = plan.infeasibility->reason.message;
    return json;
  }
  if (plan.status == SolveStatus::failed) {
    json["message"] = plan.message;
    return json;
  }
  json["energy_J"] = plan.energy.total_J();
  json["motion_energy_J"] = plan.energy.motion_J();
  json["duration_s"] = plan.duration_s;
  json["distance_m"] = plan.distance_m;
  json["optimality_gap_percent"] = plan.gap_percent;
  for (const BaselineTotal& baseline : plan.baselines)
    if (baseline.name == "trapezoid_best_tuned" && baseline.feasible)
      json["saving_percent"] = saving_percent(plan.energy.total_J(), baseline.energy_J);
  if (plan.battery) json["battery_end_fraction"] = plan.battery->end_fraction;
  return json;
}

/// FNV-1a over parts; the length of each part is mixed in, so that no two lists of parts run together.
class ContentHash {
 public:
  void mix(const std::string& part) {
    for (const char c : part + "/" + std::to_string(part.size()))
      hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }
  [[nodiscard]] std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
    return digits;
  }

 private:
  std::uint64_t hash_{1469598103934665603ULL};
};

std::string text_of(const PlanOptions& o) {
  const Json json{{"seed", o.seed},
                  {"nodes", o.nodes},
                  {"accuracy", o.accuracy},
                  {"solver", static_cast<int>(o.solver)},
                  {"steps", {o.steps.corners, o.steps.routes, o.steps.stops, o.steps.refinement}},
                  {"baselines", o.baselines}};
  return json.dump();
}

Document document_of(const BatchItem& item) {
  return item.text.empty() ? Document::load(item.file)
                           : Document::parse(item.text, item.file, item.first_line);
}

}  // namespace

std::vector<BatchItem> batch_items(const std::string& source) {
  std::vector<BatchItem> items =
      std::filesystem::is_directory(source) ? items_of_directory(source) : items_of_lines(source);
  if (items.empty())
    throw ConfigError({.mark = {.file = source},
                       .key = {},
                       .found = "no missions",
                       .accepted = "a directory with *.yaml missions, or a file of JSON lines",
                       .hint = {}});
  return items;
}

std::uint64_t BatchPlanner::content_digest(const std::string& file) {
  const auto known = digests_.find(file);
  if (known != digests_.end()) return known->second;
  ContentHash hash;
  hash.mix(read_text_file(file));
  return digests_[file] = hash.value();
}

std::string BatchPlanner::fingerprint(const BatchItem& item) try {
  ContentHash hash;
  for (const std::string& part : {std::string(JOULEPATH_VERSION), item.name, item.text, text_of(options_)})
    hash.mix(part);
  if (item.text.empty()) hash.mix(read_text_file(item.file));
  const MissionRequest mission = mission_from(document_of(item), reading_);
  for (const std::string& file : files_read_by(mission, reading_))
    hash.mix(file + "=" + std::to_string(content_digest(file)));
  return hash.text();
} catch (const std::exception&) {
  return "";  // planning it tells why
}

const BatchPlanner::Place& BatchPlanner::place_of(const MissionRequest& mission) {
  std::string key;
  for (const std::string& part :
       {mission.robot_file, mission.map_file, mission.keepout_file, mission.route_graph_file,
        mission.speed_mask ? mission.speed_mask->file : std::string(), std::to_string(mission.clearance_m)})
    key += part + "\n";
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Place>& place = places_[key];
  if (!place) {
    auto made = std::make_unique<Place>();
    made->world = read_world(mission, reading_);
    made->space = route_space(mission, made->world);
    place = std::move(made);
  }
  return *place;
}

BatchResult BatchPlanner::plan(const BatchItem& item, std::size_t index) {
  const auto start = std::chrono::steady_clock::now();
  Json json{{"index", index}, {"name", item.name}};
  try {
    const Document document = document_of(item);
    MissionRequest mission = mission_from(document, reading_);
    if (item.text.empty() || document.root().has("name")) json["name"] = mission.name;
    const Place& place = place_of(mission);
    json.update(
        plan_line(plan_mission(mission, place.world, options_, place.space ? &*place.space : nullptr)));
  } catch (const ConfigError& error) {
    json["status"] = "bad_input";
    json["message"] = printable(error.what());
  } catch (const std::bad_alloc&) {
    json["status"] = "environment_error";
    json["message"] = "not enough memory";
  } catch (const std::system_error& error) {
    json["status"] = "environment_error";
    json["message"] = printable(error.what());
  } catch (const std::exception& error) {
    json["status"] = "internal_error";
    json["message"] = printable(error.what());
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return {.index = index,
          .line = json.dump(-1, ' ', false, Json::error_handler_t::replace),
          .status = json["status"],
          .seconds = elapsed.count()};
}

void run_batch(const std::vector<std::size_t>& indices, unsigned threads,
               const std::function<BatchResult(std::size_t)>& work,
               const std::function<void(const BatchResult&)>& done, const std::function<bool()>& stop) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr error;
  std::mutex mutex;
  const auto loop = [&] {
    try {
      for (std::size_t k = next++; k < indices.size() && !failed && !stop(); k = next++) {
        const BatchResult result = work(indices[k]);
        const std::lock_guard lock(mutex);
        done(result);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failed.exchange(true)) error = std::current_exception();
    }
  };
  {
    struct Workers {
      std::vector<std::thread> threads{};
      ~Workers() {
        for (std::thread& thread : threads) thread.join();
      }
    } workers;
    for (unsigned t = 1; t < threads && t < indices.size(); ++t) workers.threads.emplace_back(loop);
    loop();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace joulepath
