#include "planner/ways/spline_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "planner/path/shape/nlopt_run.hpp"

namespace joulepath {
namespace {

using MemberKind = SplineMember::Kind;

constexpr double kLeastHandle_m = 0.01, kMostHandle_m = 20;
constexpr double kReach_m = 3;         ///< how far a knot may move
constexpr double kPart_m = 0.8;        ///< length of the parts that each have a constraint of clearance
constexpr std::size_t kMostParts = 6;  ///< per span
constexpr double kSlackStep_m = 0.03;
constexpr double kTrust = 0.7;        ///< share of the excess of slack that a step may take
constexpr double kStep_m = 1e-4;      ///< of differences of the clearance
constexpr double kTightShare = 0.98;  ///< of the tightest curvature that a search aims for
constexpr double kWide = -3;          ///< least logarithm of a bend that counts
constexpr int kLooks = 16;            ///< places of a span that are looked at
constexpr int kRefusedToo = 3;        ///< trials per evaluation at most: splines that are no curves cost little
constexpr double kNotDrivable = 100;  ///< in units of the first cost
/// A search ends that after so many evaluations is dearer than the cost to beat by more than this share.
constexpr struct {
  int evaluations{};
  double excess{};
} kHopeless[] = {{5, 0.10}, {9, 0.03}, {14, 0.01}};

/// Of a constant or a changing spline.
template <class Spline>
auto& value_of(Spline& spline, const SplineMember& member, std::size_t axis) {
  switch (member.kind) {
    case MemberKind::start_heading:
      return spline.start_heading_rad;
    case MemberKind::start_handle:
      return spline.start_handle_m;
    case MemberKind::goal_heading:
      return spline.goal_heading_rad;
    case MemberKind::goal_handle:
      return spline.goal_handle_m;
    default:
      return spline.points_m[member.knot][axis];
  }
}

double slope_of(const SplineSlopes& slopes, const SplineMember& member, std::size_t axis) {
  switch (member.kind) {
    case MemberKind::start_heading:
      return slopes.by_start_heading_rad;
    case MemberKind::start_handle:
      return slopes.by_start_handle_m;
    case MemberKind::goal_heading:
      return slopes.by_goal_heading_rad;
    case MemberKind::goal_handle:
      return slopes.by_goal_handle_m;
    default:
      return slopes.by_point_m[member.knot][axis];
  }
}

bool is_handle(MemberKind kind) {
  return kind == MemberKind::start_handle || kind == MemberKind::goal_handle;
}

double curvature_of(const BezierPoints& span, double t) {
  const BezierDerivatives b = bezier_derivatives(span, t);
  const double speed = std::max(std::hypot(b.first_m[0], b.first_m[1]), 1e-9);
  return (b.first_m[0] * b.second_m[1] - b.first_m[1] * b.second_m[0]) / (speed * speed * speed);
}

/// A part of a span that has a constraint of its own.
struct Part {
  std::size_t spline{}, span{};
  double from{}, to{};  ///< shares of the span's length
};

class Search {
 public:
  explicit Search(const SplineSearch& search) : search_(search) {}
  std::optional<SplineSearchResult> run();

 private:
  struct Column {
    std::size_t variable{}, axis{};
  };
  struct Trial {
    std::vector<double> x{};
    std::vector<FreeSpline> splines{};
    std::vector<Path> paths{};  ///< empty: a spline is no curve
    double cost{};              ///< NaN: not known yet
  };
  const SplineVariable& variable(std::size_t i) const { return search_.variables[columns_[i].variable]; }
  void take_first();
  const Trial& trial(const std::vector<double>& x);
  double objective(const std::vector<double>& x, std::vector<double>& gradient);
  struct Nearest {
    double slack_m{}, s_m{};
  };
  Nearest nearest_on(const Part& part, const Curve& curve) const;
  PointSlope slack_slope(const Part& part, const Curve& curve, double s_m) const;
  void bends(double* result, const Trial& here, double* gradient) const;
  void constraints(double* result, const std::vector<double>& x, double* gradient);
  void keep(const Trial& here);
  [[nodiscard]] bool hopeless() const;
  std::vector<double> gradient_of(const std::vector<FreeSpline>& at, const std::vector<SplineSlopes>& slopes,
                                  std::size_t only) const;
  void make_parts(const Trial& here);

  const SplineSearch& search_;
  std::vector<Column> columns_{};
  std::vector<double> x_{}, lower_{}, upper_{};
  std::vector<Part> parts_{};
  std::size_t spans_{};  ///< of all splines
  Trial last_{};
  double scale_{1};
  int evaluations_{};
  double least_{kNoLimit};  ///< cost so far, also of paths that are not free
  std::optional<SplineSearchResult> best_{};
};

void Search::take_first() {
  for (std::size_t v = 0; v < search_.variables.size(); ++v) {
    const SplineMember& member = search_.variables[v].members.front();
    const FreeSpline& spline = search_.first[member.spline];
    for (std::size_t axis = 0; axis < (member.kind == MemberKind::knot ? 2u : 1u); ++axis) {
      const double value = value_of(spline, member, axis);
      columns_.push_back({v, axis});
      if (is_handle(member.kind)) {
        x_.push_back(std::log(std::clamp(value, kLeastHandle_m, kMostHandle_m)));
        lower_.push_back(std::log(kLeastHandle_m));
        upper_.push_back(std::log(kMostHandle_m));
        continue;
      }
      const double reach = member.kind == MemberKind::knot ? kReach_m : std::numbers::pi;
      x_.push_back(value);
      lower_.push_back(value - reach);
      upper_.push_back(value + reach);
    }
  }
}

const Search::Trial& Search::trial(const std::vector<double>& x) {
  if (last_.x == x) return last_;
  last_ = {.x = x, .splines = search_.first, .cost = std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const SplineMember& member : variable(i).members)
      value_of(last_.splines[member.spline], member, columns_[i].axis) =
          is_handle(member.kind) ? std::exp(x[i]) : x[i];
  for (const FreeSpline& spline : last_.splines) {
    std::optional<Path> path = free_spline_path(spline);
    if (!path) {
      last_.paths.clear();
      break;
    }
    last_.paths.push_back(std::move(*path));
  }
  return last_;
}

/// Derivatives by the variables; of one spline's alone where `only` names it.
std::vector<double> Search::gradient_of(const std::vector<FreeSpline>& at,
                                        const std::vector<SplineSlopes>& slopes, std::size_t only) const {
  std::vector<double> gradient(columns_.size(), 0.0);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    for (const SplineMember& member : variable(i).members) {
      if (only < at.size() && member.spline != only) continue;
      const SplineSlopes& of = slopes[only < at.size() ? 0 : member.spline];
      const double factor = is_handle(member.kind) ? value_of(at[member.spline], member, 0) : 1.0;
      gradient[i] += factor * slope_of(of, member, columns_[i].axis);
    }
  return gradient;
}

double Search::objective(const std::vector<double>& x, std::vector<double>& gradient) {
  const Trial& here = trial(x);
  if (!gradient.empty()) std::fill(gradient.begin(), gradient.end(), 0.0);
  if (here.paths.empty()) return std::isfinite(least_) ? 1.1 * least_ / scale_ : kNotDrivable;
  if (std::isnan(here.cost)) {
    ++evaluations_;
    last_.cost = search_.cost(here.paths);
    if (std::isfinite(here.cost)) {
      if (scale_ == 1) scale_ = here.cost;
      keep(here);
      least_ = std::min(least_, here.cost);
    }
    if (hopeless() || evaluations_ >= search_.most_evaluations) throw nlopt::forced_stop();
  }
  if (!std::isfinite(here.cost)) return kNotDrivable;
  if (!gradient.empty()) {
    gradient = gradient_of(here.splines, search_.slopes(here.splines), here.splines.size());
    for (double& part : gradient) part /= scale_;
  }
  return here.cost / scale_;
}

bool Search::hopeless() const {
  if (!std::isfinite(search_.cost_to_beat)) return false;
  const double excess = (least_ - search_.cost_to_beat) / std::abs(search_.cost_to_beat);
  return std::any_of(std::begin(kHopeless), std::end(kHopeless),
                     [&](const auto& at) { return evaluations_ >= at.evaluations && excess > at.excess; });
}

void Search::keep(const Trial& here) {
  if (best_ && here.cost >= best_->cost) return;
  for (const Path& path : here.paths)
    if (search_.checker->least_slack_m(path) < kClearanceMargin_m || search_.checker->first_collision(path))
      return;
  best_ = {.splines = here.splines, .paths = here.paths, .cost = here.cost};
}

void Search::make_parts(const Trial& here) {
  for (std::size_t spline = 0; spline < here.paths.size(); ++spline) {
    const std::vector<double>& ends_m = std::get<Curve>(here.paths[spline].pieces.front()).breakpoints_m();
    spans_ += ends_m.size() - 1;
    for (std::size_t span = 0; span + 1 < ends_m.size(); ++span) {
      const double length_m = ends_m[span + 1] - ends_m[span];
      const auto count =
          std::clamp(static_cast<std::size_t>(std::ceil(length_m / kPart_m)), std::size_t{1}, kMostParts);
      for (std::size_t i = 0; i < count; ++i)
        parts_.push_back({spline, span, static_cast<double>(i) / static_cast<double>(count),
                          static_cast<double>(i + 1) / static_cast<double>(count)});
    }
  }
}

/// The place with the least slack on a part of a path.
Search::Nearest Search::nearest_on(const Part& part, const Curve& curve) const {
  const double s0_m = curve.breakpoints_m()[part.span],
               length_m = curve.breakpoints_m()[part.span + 1] - s0_m;
  const double end_m = s0_m + part.to * length_m;
  Nearest nearest{.slack_m = kNoLimit};
  for (double s_m = s0_m + part.from * length_m;;) {
    const double slack_m = search_.checker->near_slack_m(search_.checker->pose_on(curve, s_m));
    if (slack_m < nearest.slack_m) nearest = {slack_m, s_m};
    if (s_m >= end_m) return nearest;
    s_m = std::min(end_m, s_m + std::max(kSlackStep_m, kTrust * (slack_m - nearest.slack_m)));
  }
}

/// Derivatives of the slack at a place.
PointSlope Search::slack_slope(const Part& part, const Curve& curve, double s_m) const {
  const Pose pose = curve.at(s_m).pose;
  const auto by = [&](double dx_m, double dy_m, double turn_rad) {
    const auto slack_at = [&](double step_m) {
      return search_.checker->near_slack_m(
          {pose.x_m + step_m * dx_m, pose.y_m + step_m * dy_m, pose.heading_rad + step_m * turn_rad});
    };
    return (slack_at(kStep_m) - slack_at(-kStep_m)) / (2 * kStep_m);
  };
  const auto& segment = std::get<BezierSegment>(curve.segments()[part.span]);
  const double along_m = std::clamp(s_m - curve.breakpoints_m()[part.span], 0.0, segment.length_m());
  return {.span = part.span,
          .t = segment.parameter(along_m),
          .by_x_m = by(1, 0, 0),
          .by_y_m = by(0, 1, 0),
          .by_heading_rad = search_.checker->is_disc() ? 0.0 : by(0, 0, 1)};
}

/// Per span: how far its curvature is above the tightest one, in logarithms; spans that bend much less count as
/// kWide. Steps that know of the bound do not end in splines that are none (free_spline.hpp).
void Search::bends(double* result, const Trial& here, double* gradient) const {
  for (std::size_t k = 0; k < here.splines.size(); ++k) {
    const std::vector<BezierPoints> spans = spline_spans(here.splines[k]);
    for (std::size_t span = 0; span < spans.size(); ++span, ++result) {
      double tightest = 0, at = 0;
      for (int i = 0; i <= kLooks; ++i) {
        const double t = static_cast<double>(i) / kLooks;
        const double curvature = curvature_of(spans[span], t);
        if (std::abs(curvature) > std::abs(tightest)) tightest = curvature, at = t;
      }
      *result = std::max(kWide, std::log(std::abs(tightest) / (kTightShare * kTightest_per_m)));
      if (!gradient) continue;
      if (*result > kWide) {
        const PointSlope slope{.span = span, .t = at, .by_curvature = 1 / tightest};
        const std::vector<double> by =
            gradient_of(here.splines, {spline_slopes(here.splines[k], slope)}, k);
        std::copy(by.begin(), by.end(), gradient);
      }
      gradient += columns_.size();
    }
  }
}

/// Per part of a path: margin less the least slack on it <= 0, in metres. Per span: its bend.
void Search::constraints(double* result, const std::vector<double>& x, double* gradient) {
  const Trial& here = trial(x);
  const std::size_t rows = parts_.size() + spans_;
  if (gradient) std::fill(gradient, gradient + rows * x.size(), 0.0);
  std::fill(result, result + rows, 0.0);
  if (here.paths.empty()) return;
  bends(result + parts_.size(), here, gradient ? gradient + parts_.size() * x.size() : nullptr);
  for (std::size_t j = 0; j < parts_.size(); ++j) {
    const Part& part = parts_[j];
    const Curve& curve = std::get<Curve>(here.paths[part.spline].pieces.front());
    const Nearest nearest = nearest_on(part, curve);
    result[j] = kClearanceMargin_m - nearest.slack_m;
    if (!gradient) continue;
    const PointSlope slope = slack_slope(part, curve, nearest.s_m);
    if (slope.by_x_m == 0 && slope.by_y_m == 0 && slope.by_heading_rad == 0) continue;
    const std::vector<double> by =
        gradient_of(here.splines, {spline_slopes(here.splines[part.spline], slope)}, part.spline);
    for (std::size_t i = 0; i < x.size(); ++i) gradient[j * x.size() + i] = -by[i];
  }
}

std::optional<SplineSearchResult> Search::run() {
  take_first();
  if (trial(x_).paths.empty()) return std::nullopt;
  make_parts(last_);
  nlopt::opt optimizer(nlopt::LD_SLSQP, static_cast<unsigned>(x_.size()));
  optimizer.set_lower_bounds(lower_);
  optimizer.set_upper_bounds(upper_);
  optimizer.set_min_objective([](const std::vector<double>& x, std::vector<double>& gradient,
                                 void* self) { return static_cast<Search*>(self)->objective(x, gradient); },
                              this);
  optimizer.add_inequality_mconstraint(
      [](unsigned, double* result, unsigned n, const double* x, double* gradient, void* self) {
        static_cast<Search*>(self)->constraints(result, std::vector<double>(x, x + n), gradient);
      },
      this, std::vector<double>(parts_.size() + spans_, 1e-5));
  optimizer.set_ftol_rel(1e-5);
  optimizer.set_xtol_rel(1e-6);
  optimizer.set_maxeval(kRefusedToo * search_.most_evaluations);
  optimize_as_far_as_possible(optimizer, x_);
  if (best_) best_->evaluations = evaluations_;
  return std::move(best_);
}

}  // namespace

std::optional<SplineSearchResult> minimize(const SplineSearch& search) { return Search(search).run(); }

}  // namespace joulepath
