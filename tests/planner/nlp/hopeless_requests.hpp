#pragma once

#include <functional>
#include <string>
#include <vector>

#include "planner/values/profile_request.hpp"

namespace joulepath::testing {

/// Requests of the Nomad on 80 nodes for the fast solver, in free time.
[[nodiscard]] ProfileRequest straight_run(double length_m = 10);
[[nodiscard]] ProfileRequest run_on(PathPiece piece);
[[nodiscard]] ProfileRequest bezier_run();
[[nodiscard]] ProfileRequest turn_run();

[[nodiscard]] ProfileRequest changed(ProfileRequest request,
                                     const std::function<void(ProfileRequest&)>& change);
[[nodiscard]] ProfileRequest within(ProfileRequest request, TimeMode mode, double duration_s);
[[nodiscard]] double minimum_s(ProfileRequest request);
void set_both_motors(ProfileRequest& request, double Motor::*member, double value);

/// A request without any profile, and the constraint that its verdict must name.
struct HopelessRequest {
  std::string name;
  ProfileRequest request;
  std::string constraint;
};
[[nodiscard]] std::vector<HopelessRequest> hopeless_requests();

}  // namespace joulepath::testing
