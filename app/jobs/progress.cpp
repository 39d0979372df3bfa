#include "app/jobs/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <utility>

#include "model/progress.hpp"

namespace joulepath {
namespace {

constexpr double kSilent_s = 1.0;

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

std::string progress_text(const std::string& what, std::size_t done, std::size_t total, std::size_t earlier,
                          double elapsed_s) {
  const double rate = static_cast<double>(done - earlier) / elapsed_s;
  const double left_s = rate > 0 ? static_cast<double>(total - std::min(done, total)) / rate : 0.0;
  char text[96];
  std::snprintf(text, sizeof text, " %zu/%zu, %.3g/s, %.0f s left", done, total, rate, left_s);
  return what + text;
}

Progress::Progress(std::string what, std::size_t total, bool quiet, std::size_t done)
    : what_(std::move(what)),
      total_(total),
      done_(done),
      earlier_(done),
      quiet_(quiet || step_count != nullptr),
      on_terminal_(isatty(STDERR_FILENO) == 1) {
  expect_steps(total);
  finish_steps(done);
}

Progress::~Progress() {
  if (shown_ && on_terminal_) std::fprintf(stderr, "\r\033[K");
}

void Progress::advance(std::size_t steps) {
  done_ += steps;
  finish_steps(steps);
  if (quiet_) return;
  const auto now = Clock::now();
  if (seconds_between(start_, now) < kSilent_s || seconds_between(last_, now) < (on_terminal_ ? 0.2 : 10.0))
    return;
  show(now);
}

void Progress::show(Clock::time_point now) {
  last_ = now;
  shown_ = true;
  const std::string text = progress_text(what_, done_, total_, earlier_, seconds_between(start_, now));
  std::fprintf(stderr, on_terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
  std::fflush(stderr);
}

Waiting::Waiting(std::string what, bool quiet) : what_(std::move(what)) {
  if (quiet || isatty(STDERR_FILENO) != 1) return;
  try {
    teller_ = std::thread([this] { tell(); });
  } catch (const std::system_error&) {  // the computation goes on without a progress line
  }
}

Waiting::~Waiting() {
  if (!teller_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  ended_.notify_all();
  teller_.join();
}

void Waiting::tell() {
  std::unique_lock lock(mutex_);
  int seconds = 0;
  for (; !ended_.wait_for(lock, std::chrono::seconds(1), [this] { return done_; }); std::fflush(stderr))
    std::fprintf(stderr, "\r\033[K%s, %d s", what_.c_str(), ++seconds);
  if (seconds > 0) std::fprintf(stderr, "\r\033[K");
}

}  // namespace joulepath
