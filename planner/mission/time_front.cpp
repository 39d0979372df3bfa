#include "planner/mission/time_front.hpp"

#include <algorithm>
#include <limits>

namespace joulepath {
namespace {

double slope_W(const TimeFront::Point& a, const TimeFront::Point& b) {
  return (b.cost_J - a.cost_J) / (b.time_s - a.time_s);
}

}  // namespace

TimeFront TimeFront::below(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::pair(a.time_s, a.cost_J) < std::pair(b.time_s, b.cost_J);
  });
  TimeFront front{points.front()};
  std::vector<Point>& kept = front.points_;
  for (const Point& point : points) {
    if (!(point.cost_J < kept.back().cost_J && point.time_s > kept.back().time_s)) continue;
    while (kept.size() > 1 &&
           slope_W(kept[kept.size() - 2], kept.back()) >= slope_W(kept[kept.size() - 2], point))
      kept.pop_back();
    kept.push_back(point);
  }
  return front;
}

double TimeFront::at(double time_s) const {
  if (time_s < soonest_s()) return std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < points_.size(); ++k)
    if (time_s < points_[k + 1].time_s)
      return points_[k].cost_J + slope_W(points_[k], points_[k + 1]) * (time_s - points_[k].time_s);
  return least_J();
}

TimeFront operator+(const TimeFront& first, const TimeFront& second) {
  struct Step {
    double time_s{}, cost_J{};
  };
  std::vector<Step> steps;
  for (const TimeFront* front : {&first, &second})
    for (std::size_t k = 0; k + 1 < front->points_.size(); ++k)
      steps.push_back({front->points_[k + 1].time_s - front->points_[k].time_s,
                       front->points_[k + 1].cost_J - front->points_[k].cost_J});
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.cost_J * b.time_s < b.cost_J * a.time_s; });
  const TimeFront::Point &a = first.points_.front(), &b = second.points_.front();
  TimeFront sum{{a.time_s + b.time_s, a.cost_J + b.cost_J}};
  for (const Step& step : steps)
    sum.points_.push_back({sum.points_.back().time_s + step.time_s, sum.points_.back().cost_J + step.cost_J});
  return sum;
}

void TimeFront::wait_until(double time_s, double waiting_W) {
  if (time_s <= soonest_s()) return;
  const double waits_s = std::max(0.0, time_s - points_.back().time_s);
  const Point first{time_s, at(time_s) + waiting_W * waits_s};
  std::erase_if(points_, [&](const Point& point) { return point.time_s <= time_s; });
  points_.insert(points_.begin(), first);
}

void TimeFront::end_at(double time_s) {
  if (time_s >= points_.back().time_s) return;
  const Point last{std::max(time_s, soonest_s()), at(std::max(time_s, soonest_s()))};
  std::erase_if(points_, [&](const Point& point) { return point.time_s >= last.time_s; });
  points_.push_back(last);
}

void TimeFront::shift(double time_s, double cost_J) {
  for (Point& point : points_) {
    point.time_s += time_s;
    point.cost_J += cost_J;
  }
}

bool TimeFront::is_below(const TimeFront& other) const {
  if (soonest_s() > other.soonest_s()) return false;
  for (const std::vector<Point>* points : {&points_, &other.points_})
    for (const Point& point : *points)
      if (at(point.time_s) > other.at(point.time_s)) return false;
  return true;
}

}  // namespace joulepath
