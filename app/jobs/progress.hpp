#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace joulepath {

/// `plans 8/36, 2/s, 14 s left`: of `total` steps, `done` are done, `earlier` of them before these seconds.
[[nodiscard]] std::string progress_text(const std::string& what, std::size_t done, std::size_t total,
                                        std::size_t earlier, double elapsed_s);

/// Progress on stderr, silent for the first second: a line with rate and remaining time that is updated on a
/// terminal, a plain line every ten seconds elsewhere. A count of steps takes its place. It is never part of
/// a result.
class Progress {
 public:
  /// `done`: steps that an earlier run has done; the rate is that of this run.
  Progress(std::string what, std::size_t total, bool quiet, std::size_t done = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(std::size_t steps = 1);

 private:
  using Clock = std::chrono::steady_clock;
  void show(Clock::time_point now);

  std::string what_;
  std::size_t total_;
  std::size_t done_;
  std::size_t earlier_;
  bool quiet_;
  bool on_terminal_;
  bool shown_{};
  Clock::time_point start_{Clock::now()};
  Clock::time_point last_{start_};
};

/// Prints on a terminal (stderr) the present computation and its seconds so far, during its lifetime and from
/// the first second on; silent elsewhere.
class Waiting {
 public:
  Waiting(std::string what, bool quiet);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  void tell();

  std::string what_;
  std::mutex mutex_{};
  std::condition_variable ended_{};
  bool done_{};
  std::thread teller_{};  ///< absent without a terminal, or where the system gives no thread
};

}  // namespace joulepath
