#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath::problems {

inline constexpr const char* kTurn = "turn";  ///< the kind of a turn in place

/// One problem of the public set: a request whose path has a curvature that is linear between knots, or a
/// turn in place.
struct Problem {
  std::string id{};
  std::string kind{};        ///< of path
  std::string robot_name{};  ///< robot in the set, without the values of the problem
  ProfileRequest request;
};

/// The knots of a path made of stretches with linear curvature, as arc lengths and curvatures.
struct Knots {
  std::vector<double> s_m{};
  std::vector<double> curvature_per_m{};
};
[[nodiscard]] Curve curve_through(const Knots& knots);
[[nodiscard]] Knots knots_of(const PathPiece& piece);

using Json = nlohmann::ordered_json;

[[nodiscard]] Json robot_json(const Robot& robot);
[[nodiscard]] Json problem_json(const Problem& problem);
/// A profile as a solution of the set: speeds at places, or, where acceleration has no steps, jerk over time.
[[nodiscard]] Json solution_json(const Profile& profile);

/// All problems of a file that problem_json() and robot_json() wrote.
[[nodiscard]] std::vector<Problem> read_problems(const std::string& file);

/// The finite limits of a problem by their keys.
[[nodiscard]] std::map<std::string, double> limits_by_key(const ProfileRequest& request);

}  // namespace joulepath::problems
