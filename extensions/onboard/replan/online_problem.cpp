#include "extensions/onboard/replan/online_problem.hpp"

#include <algorithm>
#include <cmath>

#include "model/limit_table.hpp"
#include "planner/nlp/transcription/row_selection.hpp"

namespace joulepath {
namespace {

constexpr double kShortest = 1e-6;       ///< relative to the piece: no segment is shorter
constexpr double kNoMargin = 1e-9;       ///< relative
constexpr double kRaisedBraking = 0.98;  ///< of the deceleration limit, where a cap is raised for it

/// The limit of braking along the path coordinate.
double most_braking(const ProfileRequest& request) {
  return is_turn(request.piece) ? request.limits.yaw_acceleration_rad_s2 : request.limits.deceleration_m_s2;
}

}  // namespace

OnlineProblem::OnlineProblem(const ProfileRequest& request, const Profile& plan, std::size_t nodes)
    : request_(request),
      motion_(path_motion(request_)),
      table_(request_, motion_, plan, nodes),
      limits_(request.plant.robot, request.limits, request.payload) {
  problem_.request = &request_;
  const std::size_t most = most_nodes();
  problem_.s.reserve(most);
  problem_.segments.reserve(most);
  problem_.cap.reserve(most);
  problem_.rows.reserve(most_rows());
  problem_.first_row.reserve(most);
  squares_.reserve(most);
  borders_.reserve(2 * kMostCaps + 1);
}

void OnlineProblem::set(const Situation& situation, double price_W) {
  take_limits(situation);
  place_nodes(situation);
  add_caps(situation);
  problem_.b_start = situation.rate * situation.rate;
  const bool blocked = situation.stop_at < motion_.length();
  problem_.b_end = blocked ? 0.0 : request_.end_rate * request_.end_rate;
  raise_caps(situation.s);
  request_.start_rate = situation.rate;
  if (blocked)
    request_.time = {.mode = TimeMode::time_price, .price_W = price_W};
  else
    request_.time = {.mode = TimeMode::time_budget, .duration_s = situation.time_left_s};
  nlp::set_objective(problem_);
  nlp::select_rows(problem_, no_tightenings_, squares_);
}

void OnlineProblem::take_limits(const Situation& situation) {
  const double planned_kg = motion_.payload_kg(situation.s);
  extra_kg_ = situation.payload_kg - planned_kg;
  if (std::abs(extra_kg_) <= kNoMargin * (1 + planned_kg)) extra_kg_ = 0;
  const auto [least_kg, most_kg] = std::minmax(planned_kg, request_.payload.to_kg);
  overloaded_ = extra_kg_ > 0 && most_kg + extra_kg_ > payload_limit_kg(request_.plant.robot);
  request_.limits =
      extra_kg_ == 0 ? limits_.planned() : limits_.between(least_kg + extra_kg_, most_kg + extra_kg_);
  table_.update_caps();
  problem_.terms = nlp::rows_for(request_.limits);
}

/// The situation's place, the table's nodes behind it, and the borders of the caps.
void OnlineProblem::place_nodes(const Situation& situation) {
  const double length = motion_.length(), shortest = kShortest * length;
  const double begin =
      std::clamp(situation.s, 0.0, length - 2 * shortest);  // one segment is left at the end, too
  const double end = std::clamp(situation.stop_at, begin + 2 * shortest, length);
  borders_.clear();
  for (std::size_t i = 0; i < std::min(situation.speed_caps.size(), kMostCaps); ++i) {
    borders_.push_back(situation.speed_caps[i].from_m);
    borders_.push_back(situation.speed_caps[i].to_m);
  }
  borders_.push_back(end);
  std::sort(borders_.begin(), borders_.end());
  problem_.s.assign(1, begin);
  problem_.segments.clear();
  problem_.cap.clear();
  const std::vector<double>& s = table_.s();
  for (std::size_t k = 0; k < table_.segment_count() && s[k] < end - 0.5 * shortest; ++k)
    if (s[k + 1] > problem_.s.front() + shortest)
      add_nodes_within(k, std::max(s[k], problem_.s.front()), std::min(s[k + 1], end));
}

/// Segment k of the table, or its parts between borders.
void OnlineProblem::add_nodes_within(std::size_t k, double from, double to) {
  const double shortest = kShortest * motion_.length();
  const auto add = [&](double behind) {
    const double before = problem_.s.back();
    const bool whole = before == table_.s()[k] && behind == table_.s()[k + 1];
    problem_.segments.emplace_back();
    if (whole)
      table_.copy_segment(k, extra_kg_, problem_.segments.back());
    else
      problem_.segments.back() = table_.part(before, behind, extra_kg_);
    if (problem_.cap.empty()) problem_.cap.push_back(table_.cap(k, before));
    problem_.cap.push_back(table_.cap(k, behind));
    problem_.s.push_back(behind);
  };
  if (from > problem_.s.back()) problem_.s.back() = from;  // a remainder below the shortest is dropped
  for (const double border : borders_)
    if (border > problem_.s.back() + shortest && border < to - shortest) add(border);
  add(to);
}

void OnlineProblem::add_caps(const Situation& situation) {
  for (std::size_t i = 0; i < situation.speed_caps.size(); ++i) {
    const SpeedCap& cap = situation.speed_caps[i];
    // Caps whose borders are no nodes reach to the next nodes.
    const double margin = i < kMostCaps ? kNoMargin * motion_.length() : table_.longest();
    for (std::size_t k = 0; k < problem_.s.size(); ++k) {
      if (problem_.s[k] < cap.from_m - margin || problem_.s[k] > cap.to_m + margin) continue;
      const double squared = cap.speed_m_s * cap.speed_m_s;
      if (!is_turn(request_.piece) && squared < problem_.cap[k].squared) problem_.cap[k] = {squared, "speed"};
    }
  }
}

/// A situation faster than a cap ahead allows is braked as hard as the limit of deceleration allows: the caps
/// are raised to that.
void OnlineProblem::raise_caps(double s) {
  raised_until_ = s;
  const double braking = kRaisedBraking * most_braking(request_);
  if (!std::isfinite(braking)) return;
  for (std::size_t k = 0; k < problem_.s.size(); ++k) {
    const double left = problem_.b_start - 2 * braking * (problem_.s[k] - problem_.s.front());
    if (left <= 0) break;
    if (left <= problem_.cap[k].squared * (1 + kNoMargin)) continue;
    problem_.cap[k].squared = left * (1 + kNoMargin);
    raised_until_ = problem_.s[std::min(k + 1, problem_.s.size() - 1)];
  }
}

}  // namespace joulepath
