#include "planner/baselines/clipped.hpp"

#include <algorithm>
#include <cmath>

#include "planner/baselines/finish.hpp"
#include "planner/baselines/trapezoid.hpp"

namespace joulepath {
namespace {

/// A shape, clipped with one share of the yaw acceleration.
class ClippedShape {
 public:
  ClippedShape(const ProfileRequest& request, const LocalLimits& local, double share,
               const ShapeOfDuration& shape)
      : request_(request), local_(local), grid_(local.grid(share)), shape_(shape) {}

  /// The clipped profile that takes `duration_s`; nothing if even the fastest shape is too slow.
  std::optional<Profile> profile(double duration_s) const {
    constexpr double kNearlyInstant = 1e-3;  // share of the time: clipped nearly everywhere
    double fast = kNearlyInstant, slow = 1.0;
    for (; !shape_(fast * duration_s); fast *= 1.1)
      if (fast > 1) return std::nullopt;
    const std::vector<double> fastest = squares(fast * duration_s);
    if (!local_.passes(fastest) || taken_s(fastest) > duration_s) return std::nullopt;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (fast + slow);
      (taken_s(squares(middle * duration_s)) > duration_s ? slow : fast) = middle;
    }
    return profile_from_squares(grid_.s, squares(fast * duration_s));
  }

 private:
  std::vector<double> squares(double duration_s) const {
    const Profile profile = *shape_(duration_s);
    std::vector<double> ceiling;
    for (double s : grid_.s) {
      const double rate = profile.at_s(s).rate;
      ceiling.push_back(rate * rate);
    }
    return local_.below(grid_, std::move(ceiling), most_acceleration(request_), most_deceleration(request_));
  }
  double taken_s(const std::vector<double>& b) const { return nlp::duration_of(local_.problem(), b); }

  const ProfileRequest& request_;
  const LocalLimits& local_;
  LocalLimits::Grid grid_;
  const ShapeOfDuration& shape_;
};

}  // namespace

BaselineResult clipped_baseline(const ProfileRequest& request, const char* name, const ShapeOfDuration& shape,
                                double duration_s, std::map<std::string, double> parameters) {
  BaselineResult whole = no_baseline(name, "no such shape has this duration");
  if (std::optional<Profile> profile = shape(duration_s))
    whole = finish_baseline(request, name, std::move(*profile), duration_s, parameters);
  if (whole.feasible) return whole;
  parameters["clipped"] = 1;
  BaselineResult clipped =
      best_share(request, LocalLimits(request).shares(), [&](const ProfileRequest& inner, double share) {
        const LocalLimits local(inner);
        std::optional<Profile> profile = ClippedShape(inner, local, share, shape).profile(duration_s);
        if (!profile) return no_baseline(name, "cannot meet the time within the local limits of the path");
        return finish_baseline(request, name, std::move(*profile), duration_s, parameters);
      });
  if (!clipped.feasible && !clipped.profile && whole.profile)
    clipped.reason += "; unclipped, " + whole.reason;
  return clipped;
}

}  // namespace joulepath
