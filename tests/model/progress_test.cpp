#include "model/progress.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "model/workers.hpp"

namespace joulepath {
namespace {

using Calls = std::vector<std::pair<std::size_t, std::size_t>>;

StepCount::Report into(Calls& calls) {
  return [&calls](std::size_t done, std::size_t expected) { calls.emplace_back(done, expected); };
}

TEST(StepCount, TellsStepsAndExpectations) {
  Calls calls;
  StepCount count(into(calls));
  const StepScope scope(&count);
  expect_steps(2);
  finish_steps();
  expect_steps(1);
  finish_steps(2);
  EXPECT_EQ(calls, (Calls{{0, 2}, {1, 2}, {1, 3}, {3, 3}}));
}

TEST(StepCount, FinishTellsStepsThatWereNotNeeded) {
  Calls calls;
  StepCount count(into(calls));
  count.finish();
  count.expect(3);
  count.finish();
  count.finish();
  EXPECT_EQ(calls, (Calls{{0, 3}, {3, 3}}));
}

TEST(StepCount, WithoutACountNothingIsCounted) {
  expect_steps(2);
  finish_steps();
  EXPECT_EQ(step_count, nullptr);
}

TEST(StepCount, StepsWithinAStepStayOut) {
  Calls calls;
  StepCount count(into(calls));
  const StepScope scope(&count);
  expect_steps(1);
  {
    const StepScope uncounted(nullptr);
    expect_steps(5);
    finish_steps(5);
  }
  finish_steps();
  EXPECT_EQ(calls, (Calls{{0, 1}, {1, 1}}));
}

TEST(StepCount, WorkersCountForTheirCaller) {
  Calls calls;
  StepCount count(into(calls));
  const StepScope scope(&count);
  expect_steps(100);
  for_each_index(100, 3, [](std::size_t) { finish_steps(); });
  EXPECT_EQ(calls.size(), 101u);
  EXPECT_EQ(calls.back(), (std::pair<std::size_t, std::size_t>{100, 100}));
}

TEST(StepCount, AReportThatThrowsEndsTheWork) {
  StepCount count([](std::size_t done, std::size_t) {
    if (done == 3) throw std::runtime_error("enough");
  });
  const StepScope scope(&count);
  std::size_t begun = 0;
  const auto work = [&] {
    for_each_index(100, 1, [&](std::size_t) {
      ++begun;
      finish_steps();
    });
  };
  EXPECT_THROW(work(), std::runtime_error);
  EXPECT_EQ(begun, 3u);
}

}  // namespace
}  // namespace joulepath
