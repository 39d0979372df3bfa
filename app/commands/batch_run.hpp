#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "planner/mission/mission.hpp"
#include "scenarios/document.hpp"

namespace joulepath {

/// One mission of a batch, not yet parsed: a broken one must not stop the others.
struct BatchItem {
  std::string name{};
  std::string file{};
  std::string text{};
  int first_line{1};
};

/// The missions of a directory (*.yaml, by name) or of a file of JSON lines. Throws ConfigError when there
/// are none.
[[nodiscard]] std::vector<BatchItem> batch_items(const std::string& source);

/// What came of one mission.
struct BatchResult {
  std::size_t index{};
  std::string line{};    ///< one JSON object
  std::string status{};  ///< a plan's status, or `bad_input`, `environment_error`, `internal_error`
  double seconds{};
};

/// Plans the missions of a batch; maps, keep-out masks and the floors prepared from them are made once and
/// shared. Safe to call from several threads; a result depends on its mission alone.
class BatchPlanner {
 public:
  BatchPlanner(PlanOptions options, ReadOptions reading) : options_(options), reading_(reading) {}

  [[nodiscard]] BatchResult plan(const BatchItem& item, std::size_t index);

  /// Identifies a mission and all that its result depends on: the content of every file that it reads, the
  /// options and the program's version. Empty when a file cannot be read. Not for several threads.
  [[nodiscard]] std::string fingerprint(const BatchItem& item);

 private:
  struct Place {
    MissionWorld world{};
    std::optional<RouteSpace> space{};
  };
  const Place& place_of(const MissionRequest& mission);
  std::uint64_t content_digest(const std::string& file);

  PlanOptions options_;
  ReadOptions reading_;
  std::mutex mutex_{};
  std::map<std::string, std::unique_ptr<Place>> places_{};
  std::map<std::string, std::uint64_t> digests_{};
};

/// Runs `work(k)` for the given indices on `threads` threads and hands each result to `done` on the calling
/// thread's behalf (never two at once). Stops early when `stop` says so. The first exception of `work` or
/// `done` stops it too, and is thrown when all threads are joined.
void run_batch(const std::vector<std::size_t>& indices, unsigned threads,
               const std::function<BatchResult(std::size_t)>& work,
               const std::function<void(const BatchResult&)>& done, const std::function<bool()>& stop);

}  // namespace joulepath
