#pragma once

#include <map>
#include <string>

#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// The limits that hold a fastest drive, for how long, and where first: the reason for its duration.
class HoldingLimits {
 public:
  /// Adds a stretch; `offset_m` is the arc length before it.
  void add(const ProfileRequest& request, const Profile& fastest, double offset_m = 0.0);

  /// "; acceleration limits the fastest drive for 62 % of its time, first at s = 0.1 m": the limit that holds
  /// longest. Empty if there is none.
  [[nodiscard]] std::string sentence() const;

 private:
  struct Hold {
    double time_s{};
    double first_s{};
    bool turn{};
  };
  std::map<std::string, Hold, std::less<>> holds_{};
  double time_s_{};
};

}  // namespace joulepath
